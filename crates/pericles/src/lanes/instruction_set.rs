//! Functions compiled for several instruction sets, one of which is chosen at run time.

use std::sync::atomic::{AtomicU8, Ordering};

/// The instruction set of the vector loops, in ascending order of what it holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// What every machine of the architecture has.
    Baseline,
    /// AVX2 with FMA.
    Avx2,
    /// AVX-512 (F, VL, DQ, BW).
    Avx512,
}

/// The largest set that operators of this process choose by themselves.
static MOST: AtomicU8 = AtomicU8::new(InstructionSet::Avx512 as u8);

impl InstructionSet {
    const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// The set that new operators use: the best one of this machine, or less after [`Self::limit_process`].
    pub fn detect() -> Self {
        let allowed = Self::ALL[usize::from(MOST.load(Ordering::Relaxed))];
        Self::of_machine().min(allowed)
    }

    /// Limits the operators that this process makes from now on to a set, for tests and comparisons. Returns whether the machine has the set; nothing
    /// changes if it does not.
    ///
    /// Libraries for dense matrices and Fourier transforms choose their instructions themselves.
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

    /// All sets that operators of this process may use, the best one last.
    pub fn available() -> Vec<Self> {
        let best = Self::detect();
        Self::ALL.into_iter().filter(|set| *set <= best).collect()
    }

    /// The set of a name as [`Self::name`] writes it.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|set| set.name() == name)
    }

    /// As written in run.json.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

/// Compiles one inlined function for every instruction set and chooses among the copies at run time.
///
/// Written `= body on lanes`, the function's first generic argument is the set's own type of eight doubles (see [`Lanes`](crate::lanes::Lanes)); `on floats` (inside the engine), of sixteen
/// floats. The function made takes the [`InstructionSet`](crate::lanes::InstructionSet) first: one of [`InstructionSet::available`](crate::lanes::InstructionSet::available), for any other has undefined results.
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
            [$body::<$crate::lanes::F64x8, $($argument),*>]
            [$body::<$crate::lanes::doubles_x86::Avx2x8, $($argument),*>]
            [$body::<$crate::lanes::doubles_x86::Avx512x8, $($argument),*>]
            $(#[$doc])* $visibility fn $name [$($generics)*] <$($argument),*> ($($parameter : $type),*)
        }
    };
    ($(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),* $(,)?) = $body:ident on floats) => {
        $crate::for_each_instruction_set! {
            @compile
            [$body::<$crate::lanes::F32x16, $($argument),*>]
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
