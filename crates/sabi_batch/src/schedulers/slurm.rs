//! A plan as a script for an array of Slurm jobs.

use std::path::Path;

use sabi_engine::{EngineError, ErrorKind};

use super::{RunFlags, names};
use crate::plan_file::BakePlan;
use crate::shell_word::shell_word;

/// Greatest number of jobs in an array: by default, Slurm accepts indices below 1001.
const MOST_JOBS: usize = 1000;
/// Script, with words in capitals in the places that differ between plans. With `exec`, a signal of Slurm reaches the
/// program, which then cleans up.
const TEMPLATE: &str = include_str!("slurm.sh");

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
    // The name of the file is inserted last, since it and the name of the job may contain the words in capitals.
    let text = TEMPLATE
        .replace("LAST_JOB", &last_job.to_string())
        .replace("ITEMS_FLAG", flags.items)
        .replace("ITEMS_OF_JOB\n", &items_of_job(count, chunk));
    let (before, after) = text
        .split_once("PLAN_FILE")
        .ok_or_else(|| EngineError::new(ErrorKind::Defect, "the template names no plan"))?;
    Ok(format!(
        "{}{}{after}",
        before.replace("JOB_NAME", &job),
        shell_word(name)
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
