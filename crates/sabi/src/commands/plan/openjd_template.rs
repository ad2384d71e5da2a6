//! A plan as a job template of Open Job Description, revision 2023-09.

use std::path::Path;

use sabi_engine::BakePlan;

use super::names;
use crate::exit::{Exit, Failure};

/// Greatest length of a job's name, in letters.
const LONGEST_NAME: usize = 100;
/// Template, with words in capitals in the places that differ between plans.
const TEMPLATE: &str = include_str!("openjd_template.yaml");

/// Returns a template to be used in the folder of the plan, from which its relative paths start.
pub(super) fn template(file: &Path, plan: &BakePlan) -> Result<String, Failure> {
    let (name, stem) = names(file)?;
    let job: String = stem
        .chars()
        .filter(|letter| !"{}".contains(*letter))
        .take(LONGEST_NAME)
        .collect();
    let last = plan.items.len().saturating_sub(1).to_string();
    // The name of the file is inserted last, since it may contain the words in capitals.
    let text = TEMPLATE.replace("LAST_ITEM", &last);
    let (before, after) = text
        .split_once("JOB_NAME")
        .ok_or_else(|| Failure::new(Exit::Defect, "the template has no name".to_owned()))?;
    let after = after.replacen("PLAN_FILE", &quoted(name)?, 1);
    Ok(format!("{before}{}{after}", quoted(&format!("sabi {job}"))?))
}

/// Returns a text in quotes that are valid in YAML and JSON.
fn quoted(text: &str) -> Result<String, Failure> {
    serde_json::to_string(text)
        .map_err(|error| Failure::new(Exit::Defect, format!("cannot write the template: {error}")))
}
