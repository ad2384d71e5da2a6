//! The renderer and its pipelines, made on a thread of their own.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Context;
use sabi_engine::view::{Missing, Renderer};
use sabi_engine::{EngineError, Gpu};

use crate::task::{Failed, Task};

/// The renderer of all pictures, and the pipelines that are being made.
#[derive(Default)]
pub(super) struct RendererLoader {
    renderer: Option<Pending<Arc<Renderer>>>,
    pipelines: Option<(Missing, Pending<()>)>,
}

/// Something that is made on a thread of its own.
enum Pending<T> {
    Loading(Task<Result<T, EngineError>>),
    Made(T),
    /// Error sentence, and the time of the failure.
    Failed(String, Instant),
}

/// Time after which a failure is tried again, since memory may be free then.
const AGAIN: Duration = Duration::from_secs(3);

impl RendererLoader {
    /// The renderer, once it is made.
    pub(super) fn renderer(&mut self, context: &Context, gpu: &Arc<Gpu>) -> Result<Option<Arc<Renderer>>, String> {
        let begin = || {
            let gpu = gpu.clone();
            Pending::begin(context, move || Ok(Arc::new(Renderer::new(&gpu)?)))
        };
        self.renderer.take_if(|making| making.is_stale());
        self.renderer.get_or_insert_with(begin).poll(context)
    }

    /// Whether pipelines are being made, with the last picture shown meanwhile.
    pub(super) fn is_loading(&self) -> bool {
        let pipelines = self.pipelines.as_ref().map(|(_, making)| making);
        pipelines.is_some_and(|making| matches!(making, Pending::Loading(_)))
    }

    /// Whether no pipeline is missing; starts making the missing ones otherwise, those of one picture at a time.
    pub(super) fn is_ready(
        &mut self,
        context: &Context,
        (gpu, renderer): (&Arc<Gpu>, &Arc<Renderer>),
        missing: Option<Missing>,
    ) -> Result<bool, String> {
        let Some(missing) = missing else {
            // The pipelines of this picture are made; takes over the task.
            if let Some((_, making @ Pending::Loading(_))) = &mut self.pipelines {
                let _ = making.poll(context);
            }
            return Ok(true);
        };
        self.pipelines.take_if(|(_, making)| making.is_stale());
        if let Some((known, making)) = &mut self.pipelines {
            // Pipelines of another picture that failed to be made fail for this one as well, most likely.
            let made = making.poll(context)?;
            if *known == missing || made.is_none() {
                return Ok(made.is_some());
            }
        }
        let (gpu, renderer, making) = (gpu.clone(), renderer.clone(), missing.clone());
        let making = Pending::begin(context, move || Ok(renderer.make(&gpu, &making)?));
        self.pipelines = Some((missing, making));
        Ok(false)
    }
}

impl<T: Clone + Send + 'static> Pending<T> {
    fn begin(context: &Context, make: impl FnOnce() -> Result<T, EngineError> + Send + 'static) -> Pending<T> {
        Pending::Loading(Task::start(context, make))
    }

    /// Whether it failed long enough ago to be tried again.
    fn is_stale(&self) -> bool {
        matches!(self, Pending::Failed(_, when) if when.elapsed() > AGAIN)
    }

    /// The result, once it is made.
    fn poll(&mut self, context: &Context) -> Result<Option<T>, String> {
        if let Pending::Loading(task) = self
            && let Some(come) = task.poll()
        {
            *self = match come {
                Ok(Ok(made)) => Pending::Made(made),
                Ok(Err(error)) => Pending::Failed(error.to_string(), Instant::now()),
                Err(Failed) => {
                    let why = "The model cannot be drawn, which is a mistake of the program.";
                    Pending::Failed(why.to_owned(), Instant::now())
                }
            };
        }
        match self {
            Pending::Loading(_) => Ok(None),
            Pending::Made(made) => Ok(Some(made.clone())),
            Pending::Failed(why, _) => {
                context.request_repaint_after(AGAIN);
                Err(why.clone())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end<T: Clone + Send + 'static>(mut making: Pending<T>) -> Result<T, String> {
        loop {
            if let Some(made) = making.poll(&Context::default()).transpose() {
                return made;
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn what_cannot_be_made_is_said_and_tried_again_after_a_while() {
        let context = Context::default();
        assert_eq!(end(Pending::begin(&context, || Ok(7))), Ok(7));
        let lost = || {
            Err(EngineError::new(
                sabi_engine::ErrorKind::NoAdapter,
                "the device is lost",
            ))
        };
        assert_eq!(
            end(Pending::<()>::begin(&context, lost)),
            Err("the device is lost".to_owned())
        );
        let failed = |ago| Pending::<()>::Failed(String::new(), Instant::now() - ago);
        assert!(!failed(Duration::ZERO).is_stale() && failed(2 * AGAIN).is_stale());
        let panics = Pending::<()>::begin(&context, || panic!("as this test wants"));
        assert!(end(panics).is_err_and(|why| why.contains("a mistake of the program")));
    }
}
