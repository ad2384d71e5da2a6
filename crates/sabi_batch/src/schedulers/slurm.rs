//! A plan as a script for an array of Slurm jobs.

use std::path::Path;

use sabi_engine::EngineError;

use super::{RunFlags, names};
use crate::plan_file::BakePlan;
use crate::shell_word::shell_word;

/// Greatest number of jobs in an array: by default, Slurm accepts indices below 1001.
const MOST_JOBS: usize = 1000;

/// Returns a script for the plan in this file, to be submitted from its folder.
///
/// # Errors
/// The name of the file is no text, or has characters that are not shown.
pub fn slurm_script(file: &Path, plan: &BakePlan, flags: RunFlags) -> Result<String, EngineError> {
    let [name, stem] = names(file)?;
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
    let (name, items) = (shell_word(name), items_of_job(count, chunk));
    // With `exec`, a signal of Slurm reaches the program, which then cleans up.
    Ok(format!(
        "#!/bin/bash\n\
         #SBATCH --job-name={job}\n\
         #SBATCH --array=0-{last_job}\n\
         #SBATCH --ntasks=1\n\
         #SBATCH --requeue\n\
         #SBATCH --output={job}-%A_%a.log\n\
         set -euo pipefail\n\
         {items}\
         exec \"${{SABI:-sabi}}\" run {name} {} \"$items\"\n",
        flags.items
    ))
}

/// Returns the lines that set the items of a job.
fn items_of_job(count: usize, chunk: usize) -> String {
    if chunk == 1 {
        return "items=$SLURM_ARRAY_TASK_ID\n".to_owned();
    }
    let last = count.saturating_sub(1);
    format!(
        "first=$((SLURM_ARRAY_TASK_ID * {chunk}))\n\
         last=$((first + {chunk} - 1))\n\
         if ((last > {last})); then last={last}; fi\n\
         items=$first-$last\n"
    )
}

#[cfg(test)]
mod tests {
    use super::items_of_job;

    #[test]
    fn the_last_of_several_jobs_ends_with_the_plan() {
        assert_eq!(items_of_job(1000, 1), "items=$SLURM_ARRAY_TASK_ID\n");
        let lines = "first=$((SLURM_ARRAY_TASK_ID * 3))\nlast=$((first + 3 - 1))\nif ((last > 2000)); then last=2000; fi\n\
                     items=$first-$last\n";
        assert_eq!(items_of_job(2001, 3), lines);
    }
}
