//! Thumbnails of nodes.

use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::NodeRef;
use sabi_plan::{Plan, Target};
use sabi_view::Pixels;

use super::show::{evaluate, wanted};
use super::{Job, PictureHash, Worker};
use crate::error::EngineError;
use crate::evaluating::looks::LookAssignment;
use crate::live::evaluation_error::EvaluationError;
use crate::live::event::LiveEvent;
use crate::live::flattened_request::FlattenedRequest;
use crate::live::loaded_model::LoadedModel;
use crate::live::queue::WorkProgress;
use crate::live::request::{LiveRequest, ViewSubject};
use crate::live::sized_model::SizedModel;
use crate::live::thumbnail_renderer::ThumbnailRenderer;

impl Worker {
    /// Sends thumbnails of the nodes whose results have changed.
    pub(super) fn show_thumbnails(
        &mut self,
        job: &mut Job,
        flattened: &FlattenedRequest,
    ) -> Result<(), EvaluationError> {
        let Some(sized) = self.loaded.as_mut().and_then(LoadedModel::first) else {
            return Ok(());
        };
        let nodes = job.request.thumbnails.iter();
        let targets: Vec<(NodeRef, Target)> = nodes
            .filter_map(|node| Some((node.clone(), flattened.found.get(node)?.clone())))
            .collect();
        let all: BTreeSet<Target> = targets.iter().map(|(_, target)| target.clone()).collect();
        let all: Vec<Target> = all.into_iter().collect();
        let plan = sized.plan(&flattened.without_failed(&all, &self.failed_nodes));
        let keys = keys(sized, &plan, &job.request);
        for (node, target) in targets {
            let Some(key) = keys.get(&target) else { continue };
            if self.sent.thumbnails.get(&node) == Some(key) {
                continue;
            }
            self.stop_if_superseded()?;
            match self.picture(job, flattened, &target) {
                Ok(Some(picture)) => {
                    self.sent.thumbnails.insert(node.clone(), *key);
                    self.send(LiveEvent::Thumbnail {
                        revision: job.request.revision,
                        node,
                        picture,
                    });
                }
                Ok(None) => {}
                Err(EvaluationError::Failed(error)) => {
                    // The other thumbnails would probably fail as well.
                    self.send(LiveEvent::Failed {
                        revision: job.request.revision,
                        error,
                    });
                    return Ok(());
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Sends the thumbnail of the outputs, if it is requested.
    pub(super) fn show_thumbnail_of_outputs(
        &mut self,
        job: &mut Job,
        flattened: &FlattenedRequest,
    ) -> Result<(), EvaluationError> {
        if !job.request.outputs_thumbnail {
            return Ok(());
        }
        let revision = job.request.revision;
        match self.picture_of_outputs(job, flattened) {
            Ok(Some(picture)) => self.send(LiveEvent::OutputsThumbnail { revision, picture }),
            Ok(None) => {}
            Err(EvaluationError::Failed(error)) => self.send(LiveEvent::Failed { revision, error }),
            Err(error) => return Err(error),
        }
        Ok(())
    }

    /// Draws the outputs; `None` if one of them cannot be computed.
    fn picture_of_outputs(
        &mut self,
        job: &mut Job,
        flattened: &FlattenedRequest,
    ) -> Result<Option<Pixels>, EvaluationError> {
        let Worker {
            loaded,
            failed_nodes,
            queue,
            thumbnail_renderer,
            gpu,
            options,
            ..
        } = self;
        let Some(sized) = loaded.as_mut().and_then(LoadedModel::first) else {
            return Ok(None);
        };
        let Some((targets, shows)) = wanted(sized, flattened, &ViewSubject::Outputs) else {
            return Ok(None);
        };
        let work = WorkProgress {
            queue,
            is_superseded_by_requests: true,
        };
        let plan = sized.plan(&flattened.without_failed(&targets, failed_nodes));
        let (plan, mut run) = evaluate(sized, flattened, failed_nodes, &targets, plan, &work, &mut job.totals)?;
        if plan.results.len() < targets.len() {
            return Ok(None);
        }
        let looks = sized.looks(&plan, &mut run, &shows, &work)?;
        let size = sized.model.size;
        let drawn = ThumbnailRenderer::in_place(thumbnail_renderer, gpu, options.cache_dir.as_deref())
            .and_then(|renderer| renderer.picture_of_looks(gpu, options.thumbnail_px, &sized.model, &looks));
        drawn
            .map(Some)
            .map_err(|error| EvaluationError::of_results(gpu, size, error))
    }

    /// Draws one result; `None` if the run finds that it cannot be computed.
    fn picture(
        &mut self,
        job: &mut Job,
        flattened: &FlattenedRequest,
        target: &Target,
    ) -> Result<Option<Pixels>, EvaluationError> {
        let Worker {
            loaded,
            failed_nodes,
            queue,
            thumbnail_renderer,
            gpu,
            options,
            ..
        } = self;
        let Some(sized) = loaded.as_mut().and_then(LoadedModel::first) else {
            return Ok(None);
        };
        let work = WorkProgress {
            queue,
            is_superseded_by_requests: true,
        };
        let wanted = std::slice::from_ref(target);
        let plan = sized.plan(&flattened.without_failed(wanted, failed_nodes));
        let (plan, mut run) = evaluate(sized, flattened, failed_nodes, wanted, plan, &work, &mut job.totals)?;
        let Some(result) = plan.results.first() else {
            return Ok(None);
        };
        let size = sized.model.size;
        let error = |error: EngineError| EvaluationError::of_results(gpu, size, error);
        let side = options.thumbnail_px;
        if job.request.is_flat {
            let picture = sized.flat_picture(&plan, &run, result, side, job.request.set);
            return picture.map(Some).map_err(error);
        }
        let looks = sized.looks(&plan, &mut run, &LookAssignment::One, &work)?;
        let Some(look) = looks.looks.last() else {
            return Ok(None);
        };
        let drawn = ThumbnailRenderer::in_place(thumbnail_renderer, gpu, options.cache_dir.as_deref())
            .and_then(|renderer| renderer.picture(gpu, side, &sized.model, look));
        drawn.map(Some).map_err(error)
    }
}

/// Returns a hash of what the thumbnail of each result shows.
fn keys(sized: &SizedModel, plan: &Plan, request: &LiveRequest) -> BTreeMap<Target, PictureHash> {
    let marks = [
        u8::from(sized.is_approximate(plan)),
        u8::from(request.is_flat),
        u8::from(!request.is_flat && sized.model.view.has_shade()),
    ];
    let set = if request.is_flat {
        sized.model.index_of_set(request.set)
    } else {
        0
    };
    let key = |content: &PictureHash| {
        *blake3::Hasher::new()
            .update(&marks)
            .update(&set.to_le_bytes())
            .update(content)
            .finalize()
            .as_bytes()
    };
    let results = plan.results.iter();
    results
        .map(|result| (result.target.clone(), key(&result.key)))
        .collect()
}
