//! Exact values of the inspected nodes.

use std::sync::Arc;

use sabi_export::SetKey;
use sabi_gpu::Run;
use sabi_graph::NodeRef;
use sabi_plan::{Plan, PlannedResult, Target};

use super::show::evaluate;
use super::{Job, Worker};
use crate::error::EngineError;
use crate::live::evaluation_error::EvaluationError;
use crate::live::event::{InspectedResult, LiveEvent};
use crate::live::flattened_request::FlattenedRequest;
use crate::live::loaded_model::LoadedModel;
use crate::live::queue::WorkProgress;
use crate::live::sized_model::SizedModel;

impl Worker {
    /// Sends the values of the inspected nodes if they have changed.
    pub(super) fn inspect(&mut self, job: &mut Job, flattened: &FlattenedRequest) -> Result<(), EvaluationError> {
        let inspected = job.request.inspected.clone();
        self.sent.inspected.retain(|node, _| inspected.contains(node));
        for node in inspected {
            let Some(target) = flattened.found.get(&node) else {
                continue;
            };
            self.stop_if_superseded()?;
            self.set_graph_in_full(job, flattened)?;
            match self.inspect_one(job, flattened, node, target) {
                Err(EvaluationError::Failed(error)) => self.send(LiveEvent::Failed {
                    revision: job.request.revision,
                    error,
                }),
                inspected => inspected?,
            }
        }
        Ok(())
    }

    fn inspect_one(
        &mut self,
        job: &mut Job,
        flattened: &FlattenedRequest,
        node: NodeRef,
        target: &Target,
    ) -> Result<(), EvaluationError> {
        let Worker {
            loaded,
            failed_nodes,
            queue,
            gpu,
            sent,
            ..
        } = self;
        let Some(sized) = loaded.as_mut().and_then(LoadedModel::best) else {
            return Ok(());
        };
        let wanted = std::slice::from_ref(target);
        let plan = sized.plan(&flattened.without_failed(wanted, failed_nodes));
        let Some(result) = plan.results.first() else {
            return Ok(());
        };
        let set = job.request.set;
        let marks = [u8::from(sized.is_approximate(&plan))];
        let key = *blake3::Hasher::new()
            .update(&marks)
            .update(&sized.model.index_of_set(set).to_le_bytes())
            .update(&result.key)
            .finalize()
            .as_bytes();
        if sent.inspected.get(&node) == Some(&key) {
            return Ok(());
        }
        let work = WorkProgress {
            queue,
            is_superseded_by_requests: true,
        };
        let (plan, run) = evaluate(sized, flattened, failed_nodes, wanted, plan, &work, &mut job.totals)?;
        let Some(result) = plan.results.first() else {
            return Ok(());
        };
        let size = sized.model.size;
        let values = sized
            .inspected(&plan, &run, result, set)
            .map_err(|error| EvaluationError::of_results(gpu, size, error))?;
        sent.inspected.insert(node.clone(), key);
        self.send(LiveEvent::Inspected {
            revision: job.request.revision,
            node,
            values: Arc::new(values),
        });
        Ok(())
    }
}

impl SizedModel {
    fn inspected(
        &mut self,
        plan: &Plan,
        run: &Run,
        result: &PlannedResult,
        set: Option<SetKey>,
    ) -> Result<InspectedResult, EngineError> {
        let (evaluator, set, texture_space) = self.texture_space(set)?;
        Ok(InspectedResult {
            ty: result.stored.ty,
            size: texture_space.layout.size,
            set: set.clone(),
            planes: texture_space.planes(evaluator, plan, run, result)?,
            is_on_surface: texture_space.is_owned(),
        })
    }
}
