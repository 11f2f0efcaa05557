//! Functions compiled for several instruction sets, one of which is chosen at run time.

use std::sync::atomic::{AtomicU8, Ordering};

/// An instruction set of the vector loops, in ascending order of capability.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// The baseline of the architecture.
    Baseline,
    /// AVX2 with FMA.
    Avx2,
    /// AVX-512 (F, VL, DQ, BW).
    Avx512,
}

/// The largest set that operators of this process choose by default.
static MOST: AtomicU8 = AtomicU8::new(InstructionSet::Avx512 as u8);

impl InstructionSet {
    const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// Returns the set that new operators use: the best one of this machine, unless [`Self::limit_process`] has
    /// lowered it.
    pub fn detect() -> Self {
        let allowed = Self::ALL[usize::from(MOST.load(Ordering::Relaxed))];
        Self::of_machine().min(allowed)
    }

    /// Limits operators constructed from now on in this process to a set, for tests and comparisons. Returns
    /// whether the machine supports the set; if not, nothing changes.
    ///
    /// Libraries for dense matrices and Fourier transforms choose their instructions independently.
    #[must_use]
    pub fn limit_process(self) -> bool {
        let runs = self <= Self::of_machine();
        if runs {
            MOST.store(self as u8, Ordering::Relaxed);
        }
        runs
    }

    fn of_machine() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
            {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    /// Returns all sets that operators of this process may use, the best one last.
    pub fn available() -> Vec<Self> {
        let best = Self::detect();
        Self::ALL.into_iter().filter(|set| *set <= best).collect()
    }

    /// Returns the set with a name as written by [`Self::name`].
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|set| set.name() == name)
    }

    /// Name of the set in run.json.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

/// Compiles an inlined function for every instruction set and chooses among the copies at run time.
///
/// In the form `= body on lanes` the first generic argument of the function is the type of eight doubles of the set
/// (see [`Lanes`](crate::lanes::Lanes)); with `on floats` (inside the engine) that of sixteen floats. The generated
/// function takes an [`InstructionSet`](crate::lanes::InstructionSet) as its first argument. It must be one of
/// [`InstructionSet::available`](crate::lanes::InstructionSet::available); any other is undefined behaviour.
#[macro_export]
macro_rules! for_each_instruction_set {
    ($(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),* $(,)?) = $body:ident) => {
        $crate::for_each_instruction_set! {
            @compile [$body::<$($argument),*>] [$body::<$($argument),*>] [$body::<$($argument),*>]
            $(#[$doc])* $visibility fn $name [$($generics)*] <$($argument),*> ($($parameter : $type),*)
        }
    };
    ($(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),* $(,)?) = $body:ident on lanes) => {
        $crate::for_each_instruction_set! {
            @compile
            [$body::<$crate::lanes::Baseline8, $($argument),*>]
            [$body::<$crate::lanes::doubles_x86::Avx2x8, $($argument),*>]
            [$body::<$crate::lanes::doubles_x86::Avx512x8, $($argument),*>]
            $(#[$doc])* $visibility fn $name [$($generics)*] <$($argument),*> ($($parameter : $type),*)
        }
    };
    ($(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),* $(,)?) = $body:ident on floats) => {
        $crate::for_each_instruction_set! {
            @compile
            [$body::<$crate::lanes::Baseline16, $($argument),*>]
            [$body::<$crate::lanes::floats_x86::Avx2x16, $($argument),*>]
            [$body::<$crate::lanes::floats_x86::Avx512x16, $($argument),*>]
            $(#[$doc])* $visibility fn $name [$($generics)*] <$($argument),*> ($($parameter : $type),*)
        }
    };
    (@compile [$($baseline:tt)*] [$($avx2:tt)*] [$($avx512:tt)*]
     $(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),*)) => {
        $(#[$doc])*
        #[allow(clippy::too_many_arguments)]
        $visibility fn $name<$($generics)*>(set: $crate::lanes::InstructionSet, $($parameter: $type),*) {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma")]
                fn avx512<$($generics)*>($($parameter: $type),*) {
                    $($avx512)*($($parameter),*)
                }
                #[target_feature(enable = "avx2,fma")]
                fn avx2<$($generics)*>($($parameter: $type),*) {
                    $($avx2)*($($parameter),*)
                }
                match set {
                    // SAFETY: InstructionSet::detect found these features on this machine.
                    $crate::lanes::InstructionSet::Avx512 => return unsafe { avx512::<$($argument),*>($($parameter),*) },
                    // SAFETY: as above.
                    $crate::lanes::InstructionSet::Avx2 => return unsafe { avx2::<$($argument),*>($($parameter),*) },
                    $crate::lanes::InstructionSet::Baseline => {}
                }
            }
            let _ = set;
            $($baseline)*($($parameter),*)
        }
    };
}
pub use for_each_instruction_set;
