//! A plan as a job template of Open Job Description, revision 2023-09.

use std::path::Path;

use sabi_engine::BakePlan;

use super::names;
use crate::exit::{Exit, Failure};

/// Longest name of a job, letters.
const LONGEST_NAME: usize = 100;
/// Items that a task begins with; the engine adapts them to the seconds below.
const ITEMS_OF_A_TASK: usize = 4;
const SECONDS_OF_A_TASK: usize = 120;
const MOST_SECONDS_OF_A_TASK: usize = 24 * 3600;
const SECONDS_TO_STOP: usize = 30;

/// A template for the folder of the plan: its paths start there.
pub(super) fn template(file: &Path, plan: &BakePlan) -> Result<String, Failure> {
    let (name, stem) = names(file)?;
    let job: String = stem
        .chars()
        .filter(|letter| !"{}".contains(*letter))
        .take(LONGEST_NAME)
        .collect();
    let (job, name) = (quoted(&format!("sabi {job}"))?, quoted(name)?);
    let last = plan.items.len().saturating_sub(1);
    Ok(format!(
        r#"specificationVersion: jobtemplate-2023-09
extensions: [TASK_CHUNKING]
name: {job}
parameterDefinitions:
  - name: Sabi
    type: STRING
    default: sabi
    description: The program, by its name or its path on the worker.
  - name: Plan
    type: PATH
    objectType: FILE
    dataFlow: IN
    default: {name}
  - name: Project
    type: PATH
    objectType: DIRECTORY
    dataFlow: INOUT
    default: .
    description: The folder of the plan, with all files that it names.
  - name: Items
    type: STRING
    default: "0-{last}"
  - name: Adapter
    type: STRING
    default: auto
    description: Adapter to run on - auto, cpu, gpu, or a part of its name.
steps:
  - name: Bake
    parameterSpace:
      taskParameterDefinitions:
        - name: Item
          type: CHUNK[INT]
          range: "{{{{Param.Items}}}}"
          chunks:
            defaultTaskCount: {ITEMS_OF_A_TASK}
            targetRuntimeSeconds: {SECONDS_OF_A_TASK}
            rangeConstraint: CONTIGUOUS
    script:
      actions:
        onRun:
          command: "{{{{Param.Sabi}}}}"
          args:
            - run
            - "{{{{Param.Plan}}}}"
            - --items
            - "{{{{Task.Param.Item}}}}"
            - --adapter
            - "{{{{Param.Adapter}}}}"
            - --progress
            - openjd
          timeout: {MOST_SECONDS_OF_A_TASK}
          cancelation:
            mode: NOTIFY_THEN_TERMINATE
            notifyPeriodInSeconds: {SECONDS_TO_STOP}
"#
    ))
}

/// A text in quotes as YAML and JSON have them.
fn quoted(text: &str) -> Result<String, Failure> {
    serde_json::to_string(text)
        .map_err(|error| Failure::new(Exit::Defect, format!("cannot write the template: {error}")))
}
