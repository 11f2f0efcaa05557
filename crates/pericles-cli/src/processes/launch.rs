//! How many copies of the program a launcher has started.

/// Variables with the number of processes and the number of this one. A launcher may use another one: `mpirun` in a job of
/// Slurm starts its own processes by `srun`. The variables of the innermost launcher come first.
const VARIABLES: [[&str; 2]; 6] = [
    // Open MPI.
    ["OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"],
    // MPICH, Intel MPI, and `srun --mpi=pmi2`.
    ["PMI_SIZE", "PMI_RANK"],
    // MVAPICH.
    ["MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK"],
    // `jsrun`.
    ["JSM_NAMESPACE_SIZE", "JSM_NAMESPACE_RANK"],
    // Flux.
    ["FLUX_JOB_SIZE", "FLUX_TASK_RANK"],
    // `srun`. A batch script itself has no job step.
    ["SLURM_STEP_NUM_TASKS", "SLURM_PROCID"],
];

/// The processes that a launcher has started.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Launch {
    /// Number of processes.
    pub(super) size: usize,
    /// Number of this process, counted from 0.
    pub(super) rank: usize,
}

impl Launch {
    /// Returns the launch according to environment variables; `None` for a program that no launcher has started.
    pub(super) fn found(variable: impl Fn(&str) -> Option<String>) -> Option<Self> {
        let number = |name| variable(name)?.trim().parse().ok();
        VARIABLES.iter().find_map(|[size, rank]| {
            Some(Self {
                size: number(size)?,
                rank: number(rank)?,
            })
        })
    }

    /// Returns the launch of this process.
    pub(super) fn of_process() -> Option<Self> {
        Self::found(|name| std::env::var(name).ok())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn launchers_are_recognised_by_their_variables() {
        let found = |variables: &[(&str, &str)]| {
            Launch::found(|name| {
                let of_name = variables.iter().find(|(known, _)| *known == name);
                of_name.map(|(_, value)| (*value).to_owned())
            })
            .map(|launch| (launch.size, launch.rank))
        };
        assert_eq!(found(&[]), None);
        let open = [("OMPI_COMM_WORLD_SIZE", "4"), ("OMPI_COMM_WORLD_RANK", "3")];
        assert_eq!(found(&open), Some((4, 3)));
        assert_eq!(found(&[("PMI_SIZE", "2"), ("PMI_RANK", "0")]), Some((2, 0)));
        // A batch script of Slurm, a job step, and mpirun within it.
        let script = [("SLURM_NTASKS", "8"), ("SLURM_PROCID", "0")];
        assert_eq!(found(&script), None);
        let step = [("SLURM_STEP_NUM_TASKS", "8"), ("SLURM_PROCID", "5")];
        assert_eq!(found(&step), Some((8, 5)));
        assert_eq!(found(&[&open[..], &step].concat()), Some((4, 3)));
        assert_eq!(found(&[("PMI_SIZE", "many"), ("PMI_RANK", "0")]), None);
    }
}
