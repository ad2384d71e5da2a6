//! A plan as a script for an array of Slurm jobs.

use std::path::Path;

use sabi_engine::BakePlan;

use super::names;
use super::shell_word::shell_word;
use crate::exit::Failure;

/// Most jobs of an array: Slurm takes indices below 1001 unless it is set up for more.
const MOST_JOBS: usize = 1000;

/// A script that is submitted from the folder of the plan.
pub(super) fn script(file: &Path, plan: &BakePlan) -> Result<String, Failure> {
    let (name, stem) = names(file)?;
    let job: String = stem
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || c == '_' || c == '-' {
                c
            } else {
                '_'
            }
        })
        .collect();
    let count = plan.items.len();
    let chunk = count.div_ceil(MOST_JOBS).max(1);
    let last_job = count.div_ceil(chunk).saturating_sub(1);
    let last_item = count.saturating_sub(1);
    let name = shell_word(name);
    // `exec` lets a signal of Slurm reach the program, which then cleans up.
    Ok(format!(
        "#!/bin/bash\n\
         #SBATCH --job-name={job}\n\
         #SBATCH --array=0-{last_job}\n\
         #SBATCH --ntasks=1\n\
         #SBATCH --requeue\n\
         #SBATCH --output={job}-%A_%a.log\n\
         set -euo pipefail\n\
         first=$((SLURM_ARRAY_TASK_ID * {chunk}))\n\
         last=$((first + {chunk} - 1))\n\
         if ((last > {last_item})); then last={last_item}; fi\n\
         exec \"${{SABI:-sabi}}\" run {name} --items \"$first-$last\"\n"
    ))
}
