//! Plans of the same steps.

use sabi_plan::{Plan, Step};

/// Returns true if two plans have the same steps between the same slots. The values of parameters may differ.
pub(crate) fn is_alike(plan: &Plan, other: &Plan) -> bool {
    let is_alike = |(step, other): (&Step, &Step)| match (step, other) {
        (Step::Source(step), Step::Source(other)) => {
            step.id == other.id && step.kind == other.kind && step.reads == other.reads && step.writes == other.writes
        }
        (Step::Kernel(step), Step::Kernel(other)) => {
            step.spec == other.spec
                && step.reads == other.reads
                && step.writes == other.writes
                && step.level == other.level
        }
        (Step::Move(step), Step::Move(other)) => {
            (step.from, step.to, step.levels) == (other.from, other.to, other.levels)
        }
        (Step::Survey(step), Step::Survey(other)) => step == other,
        _ => false,
    };
    plan.slots == other.slots
        && plan.steps.len() == other.steps.len()
        && plan.steps.iter().zip(&other.steps).all(is_alike)
}
