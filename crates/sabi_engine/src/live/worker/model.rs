//! Loading of the model, the coarse size before the full one.

use std::sync::Arc;

use super::{Job, Worker};
use crate::error::{EngineError, ErrorKind};
use crate::live::evaluation_error::EvaluationError;
use crate::live::event::LiveEvent;
use crate::live::flattened_request::FlattenedRequest;
use crate::live::loaded_model::LoadedModel;
use crate::live::model_reading::LoadProgress;
use crate::live::sized_model::SizedModel;
use crate::opening::linked_model::{LinkedModel, ModelOptions};
use crate::phases::{Phase, Progress};

impl Worker {
    /// Loads the model if its revision has changed, at the coarse size if there is one. The last model that was loaded is
    /// kept until another one is loaded, and can be requested again by its revision.
    pub(super) fn load_first(&mut self, job: &Job) -> Result<(), EvaluationError> {
        let request = &job.request;
        if self.tried == Some(request.model_revision) {
            return Ok(());
        }
        self.tried = Some(request.model_revision);
        let loaded = self.loaded.as_ref().map(|loaded| loaded.revision);
        if loaded == self.tried {
            return Ok(());
        }
        let is_coarse = request.coarse_size < request.model.size;
        let options = ModelOptions {
            size: if is_coarse {
                request.coarse_size
            } else {
                request.model.size
            },
            cache_dir: self.options.cache_dir.clone(),
            ..(*request.model).clone()
        };
        let progress = Arc::new(LoadProgress::new(&self.queue, request.model_revision));
        let linked = self
            .reading
            .read(&progress, move |progress| LinkedModel::open(&options, progress));
        let opened = linked.and_then(|linked| {
            progress.advance(Phase::Upload, 0, 1);
            let (linked, revision) = (Arc::new(linked), request.model_revision);
            SizedModel::new(
                &self.gpu,
                &self.options,
                request,
                &job.graph,
                linked,
                revision,
                is_coarse,
            )
        });
        let sized = match opened {
            Ok(sized) => sized,
            Err(error) => return self.model_failed(job, error),
        };
        self.send_model(&sized);
        let (coarse, full) = if is_coarse {
            (Some(sized), None)
        } else {
            (None, Some(sized))
        };
        self.loaded = Some(LoadedModel {
            revision: request.model_revision,
            options: request.model.clone(),
            coarse,
            full,
            has_full_failed: false,
        });
        self.sent.looks.clear();
        self.sent.thumbnails.clear();
        self.sent.inspected.clear();
        self.full_duration = None;
        Ok(())
    }

    /// Loads the model at full size if it is not loaded yet.
    pub(super) fn load_full(&mut self, job: &Job) -> Result<(), EvaluationError> {
        let Some(loaded) = self.loaded.as_mut().filter(|loaded| !loaded.has_full_failed) else {
            return Ok(());
        };
        let (None, Some(coarse)) = (&loaded.full, &loaded.coarse) else {
            return Ok(());
        };
        let options = ModelOptions {
            cache_dir: self.options.cache_dir.clone(),
            ..(*loaded.options).clone()
        };
        let progress = Arc::new(LoadProgress::new(&self.queue, loaded.revision));
        let linked = coarse.model.linked.clone();
        let resized = self
            .reading
            .read(&progress, move |progress| linked.resized(&options, progress));
        let sized = resized.and_then(|linked| {
            progress.advance(Phase::Upload, 0, 1);
            let (linked, revision) = (Arc::new(linked), loaded.revision);
            SizedModel::new(
                &self.gpu,
                &self.options,
                &job.request,
                &job.graph,
                linked,
                revision,
                false,
            )
        });
        match sized {
            Ok(sized) => {
                self.send_model(&sized);
                if let Some(loaded) = &mut self.loaded {
                    loaded.full = Some(sized);
                }
                Ok(())
            }
            Err(error) => {
                loaded.has_full_failed = error.kind != ErrorKind::Interrupted;
                self.model_failed(job, error)
            }
        }
    }

    /// Sets the graph of the size for first pictures.
    pub(super) fn set_graph(&mut self, job: &Job, flattened: &FlattenedRequest) -> Result<(), EvaluationError> {
        let Some(sized) = self.loaded.as_mut().and_then(LoadedModel::first) else {
            return Ok(());
        };
        let is_another = sized.set_graph(&job.request, &job.graph, &flattened.graph);
        if is_another.map_err(|error| EvaluationError::of(&self.gpu, error))?
            && let Some(sized) = self.loaded.as_mut().and_then(LoadedModel::first)
        {
            let event = model_event(sized);
            self.send(event);
        }
        Ok(())
    }

    /// Sets the graph of the full size, which is loaded if necessary. Returns true if it is available.
    pub(super) fn set_graph_in_full(
        &mut self,
        job: &Job,
        flattened: &FlattenedRequest,
    ) -> Result<bool, EvaluationError> {
        self.load_full(job)?;
        let Some(LoadedModel {
            coarse,
            full: Some(sized),
            ..
        }) = &mut self.loaded
        else {
            return Ok(false);
        };
        if coarse.is_some() {
            let is_another = sized.set_graph(&job.request, &job.graph, &flattened.graph);
            if is_another.map_err(|error| EvaluationError::of(&self.gpu, error))? {
                let event = model_event(sized);
                self.send(event);
            }
        }
        Ok(true)
    }

    fn send_model(&self, sized: &SizedModel) {
        self.send(model_event(sized));
    }

    fn model_failed(&self, job: &Job, error: EngineError) -> Result<(), EvaluationError> {
        match EvaluationError::of(&self.gpu, error) {
            EvaluationError::Failed(error) => {
                self.send(LiveEvent::ModelFailed {
                    model_revision: job.request.model_revision,
                    error,
                });
                Ok(())
            }
            error => Err(error),
        }
    }
}

fn model_event(sized: &SizedModel) -> LiveEvent {
    LiveEvent::Model {
        model_revision: sized.model.model_revision,
        size: sized.model.size,
        model: sized.model.clone(),
    }
}
