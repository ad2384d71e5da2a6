//! The renderer and its pipelines, created on a thread of their own.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Context;
use sabi_engine::EngineError;
use sabi_gpu::Gpu;
use sabi_view::{MissingPipelines, Renderer};

use crate::task::{Task, TaskFailure};

/// Renderer of all pictures, and the pipelines that are being created.
#[derive(Default)]
pub(super) struct RendererLoader {
    renderer: Option<LoadState<Arc<Renderer>>>,
    pipelines: Option<(MissingPipelines, LoadState<()>)>,
}

/// Value that is created on a thread of its own.
enum LoadState<T> {
    Loading(Task<Result<T, EngineError>>),
    Ready(T),
    /// Error sentence, and the time of the failure.
    Failed(String, Instant),
}

/// Time after which a failure is tried again, since memory may be free then.
const AGAIN: Duration = Duration::from_secs(3);

impl RendererLoader {
    /// Renderer, once it is created.
    pub(super) fn renderer(&mut self, context: &Context, gpu: &Arc<Gpu>) -> Result<Option<Arc<Renderer>>, String> {
        let begin = || {
            let gpu = gpu.clone();
            LoadState::begin(context, move || Ok(Arc::new(Renderer::new(&gpu)?)))
        };
        self.renderer.take_if(|pending| pending.is_stale());
        self.renderer.get_or_insert_with(begin).poll(context)
    }

    /// Renderer, if it is created.
    pub(super) fn made(&self) -> Option<Arc<Renderer>> {
        match &self.renderer {
            Some(LoadState::Ready(renderer)) => Some(renderer.clone()),
            _ => None,
        }
    }

    /// Returns whether pipelines are being created, with the last picture shown meanwhile.
    pub(super) fn is_loading(&self) -> bool {
        let pipelines = self.pipelines.as_ref().map(|(_, pending)| pending);
        pipelines.is_some_and(|pending| matches!(pending, LoadState::Loading(_)))
    }

    /// Returns whether no pipeline is missing; otherwise starts creating the missing pipelines, for one picture at a
    /// time.
    pub(super) fn is_ready(
        &mut self,
        context: &Context,
        gpu: &Arc<Gpu>,
        renderer: &Arc<Renderer>,
        missing: Option<MissingPipelines>,
    ) -> Result<bool, String> {
        let Some(missing) = missing else {
            // The pipelines of this picture are created; takes over the task.
            if let Some((_, pending @ LoadState::Loading(_))) = &mut self.pipelines {
                let _ = pending.poll(context);
            }
            return Ok(true);
        };
        self.pipelines.take_if(|(_, pending)| pending.is_stale());
        if let Some((known, pending)) = &mut self.pipelines {
            // If the pipelines of another picture could not be created, these most likely cannot, either.
            let made = pending.poll(context)?;
            if *known == missing || made.is_none() {
                return Ok(made.is_some());
            }
        }
        let (gpu, renderer, pending) = (gpu.clone(), renderer.clone(), missing.clone());
        let pending = LoadState::begin(context, move || Ok(renderer.make(&gpu, &pending)?));
        self.pipelines = Some((missing, pending));
        Ok(false)
    }
}

impl<T: Clone + Send + 'static> LoadState<T> {
    fn begin(context: &Context, make: impl FnOnce() -> Result<T, EngineError> + Send + 'static) -> LoadState<T> {
        LoadState::Loading(Task::start(context, make))
    }

    /// Returns whether the task failed long enough ago to be tried again.
    fn is_stale(&self) -> bool {
        matches!(self, LoadState::Failed(_, when) if when.elapsed() > AGAIN)
    }

    /// Value, once it is created.
    fn poll(&mut self, context: &Context) -> Result<Option<T>, String> {
        if let LoadState::Loading(task) = self
            && let Some(result) = task.poll()
        {
            *self = match result {
                Ok(Ok(made)) => LoadState::Ready(made),
                Ok(Err(error)) => LoadState::Failed(error.to_string(), Instant::now()),
                Err(TaskFailure) => {
                    let why = "The model cannot be drawn, which is a bug in the program.";
                    LoadState::Failed(why.to_owned(), Instant::now())
                }
            };
        }
        match self {
            LoadState::Loading(_) => Ok(None),
            LoadState::Ready(made) => Ok(Some(made.clone())),
            LoadState::Failed(why, _) => {
                context.request_repaint_after(AGAIN);
                Err(why.clone())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end<T: Clone + Send + 'static>(mut pending: LoadState<T>) -> Result<T, String> {
        loop {
            if let Some(made) = pending.poll(&Context::default()).transpose() {
                return made;
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn a_failed_creation_is_reported_and_tried_again_after_a_while() {
        let context = Context::default();
        assert_eq!(end(LoadState::begin(&context, || Ok(7))), Ok(7));
        let lost = || {
            Err(EngineError::new(
                sabi_engine::ErrorKind::NoAdapter,
                "the device is lost",
            ))
        };
        assert_eq!(
            end(LoadState::<()>::begin(&context, lost)),
            Err("the device is lost".to_owned())
        );
        let failed = |ago| LoadState::<()>::Failed(String::new(), Instant::now() - ago);
        assert!(!failed(Duration::ZERO).is_stale() && failed(2 * AGAIN).is_stale());
        let panics = LoadState::<()>::begin(&context, || panic!("as this test wants"));
        assert!(end(panics).is_err_and(|why| why.contains("a bug in the program")));
    }
}
