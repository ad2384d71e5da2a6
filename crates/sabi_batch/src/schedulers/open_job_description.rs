//! A plan as a job template of Open Job Description, revision 2023-09.

use std::path::Path;

use sabi_engine::{EngineError, ErrorKind};

use super::{RunFlags, names};
use crate::plan_file::BakePlan;

/// Greatest length of a job's name, in letters.
const LONGEST_NAME: usize = 100;
/// Template, with words in capitals in the places that differ between plans.
const TEMPLATE: &str = include_str!("open_job_description.yaml");

/// Returns a template of a job for the plan in this file, to be used in its folder, from which its relative paths start.
///
/// # Errors
/// The name of the file is no text, or has characters that are not shown.
pub fn job_template(file: &Path, plan: &BakePlan, flags: RunFlags) -> Result<String, EngineError> {
    let [name, stem] = names(file)?;
    let job: String = stem
        .chars()
        .filter(|letter| !"{}".contains(*letter))
        .take(LONGEST_NAME)
        .collect();
    let last = plan.items.len().saturating_sub(1).to_string();
    // The name of the file is inserted last, since it may contain the words in capitals.
    let [progress, openjd] = flags.openjd_progress;
    let text = TEMPLATE
        .replace("LAST_ITEM", &last)
        .replace("ITEMS_FLAG", flags.items)
        .replace("ADAPTER_FLAG", flags.adapter)
        .replace("PROGRESS_FLAG", progress)
        .replace("PROGRESS_KIND", openjd);
    let (before, after) = text
        .split_once("JOB_NAME")
        .ok_or_else(|| EngineError::new(ErrorKind::Defect, "the template has no name"))?;
    let after = after.replacen("PLAN_FILE", &quoted(name)?, 1);
    Ok(format!("{before}{}{after}", quoted(&format!("sabi {job}"))?))
}

/// Returns a text in quotes that are valid in YAML and JSON.
fn quoted(text: &str) -> Result<String, EngineError> {
    serde_json::to_string(text)
        .map_err(|error| EngineError::new(ErrorKind::Defect, format!("cannot write the template: {error}")))
}
