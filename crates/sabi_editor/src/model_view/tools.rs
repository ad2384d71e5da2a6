//! What pictures of the model are drawn with, made beside the window.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Context;
use sabi_engine::view::{Missing, Renderer};
use sabi_engine::{EngineError, Gpu};

use crate::task::{Failed, Task};

/// A renderer for all screens, and what it still needs.
#[derive(Default)]
pub(super) struct Tools {
    renderer: Option<Making<Arc<Renderer>>>,
    pipelines: Option<(Missing, Making<()>)>,
}

/// Something that is made on a thread of its own.
enum Making<T> {
    Coming(Task<Result<T, EngineError>>),
    Made(T),
    /// Why it could not be made, and when that was.
    Failed(String, Instant),
}

/// What failed is tried again after so long, since memory may be free by then; not in every frame.
const AGAIN: Duration = Duration::from_secs(3);

impl Tools {
    /// The renderer, once it is made.
    pub(super) fn renderer(&mut self, context: &Context, gpu: &Arc<Gpu>) -> Result<Option<Arc<Renderer>>, String> {
        let begin = || {
            let gpu = gpu.clone();
            Making::begin(context, move || Ok(Arc::new(Renderer::new(&gpu)?)))
        };
        self.renderer.take_if(|making| making.is_stale());
        self.renderer.get_or_insert_with(begin).poll(context)
    }

    /// Whether something is on its way, and the last picture shown meanwhile.
    pub(super) fn are_coming(&self) -> bool {
        let pipelines = self.pipelines.as_ref().map(|(_, making)| making);
        pipelines.is_some_and(|making| matches!(making, Making::Coming(_)))
    }

    /// Whether nothing is missing any more; begins to make it otherwise. What another screen misses comes one after the other.
    pub(super) fn is_ready(
        &mut self,
        context: &Context,
        (gpu, renderer): (&Arc<Gpu>, &Arc<Renderer>),
        missing: Option<Missing>,
    ) -> Result<bool, String> {
        let Some(missing) = missing else {
            // What was made for this is over, and may be the last that was.
            if let Some((_, making @ Making::Coming(_))) = &mut self.pipelines {
                let _ = making.poll(context);
            }
            return Ok(true);
        };
        self.pipelines.take_if(|(_, making)| making.is_stale());
        if let Some((known, making)) = &mut self.pipelines {
            // What another one failed for is most likely what this one would fail for, too.
            let made = making.poll(context)?;
            if *known == missing || made.is_none() {
                return Ok(made.is_some());
            }
        }
        let (gpu, renderer, making) = (gpu.clone(), renderer.clone(), missing.clone());
        let making = Making::begin(context, move || Ok(renderer.make(&gpu, &making)?));
        self.pipelines = Some((missing, making));
        Ok(false)
    }
}

impl<T: Clone + Send + 'static> Making<T> {
    fn begin(context: &Context, make: impl FnOnce() -> Result<T, EngineError> + Send + 'static) -> Making<T> {
        Making::Coming(Task::start(context, make))
    }

    /// Whether it failed long enough ago to be tried again.
    fn is_stale(&self) -> bool {
        matches!(self, Making::Failed(_, when) if when.elapsed() > AGAIN)
    }

    /// What was made, once it is.
    fn poll(&mut self, context: &Context) -> Result<Option<T>, String> {
        if let Making::Coming(task) = self
            && let Some(come) = task.poll()
        {
            *self = match come {
                Ok(Ok(made)) => Making::Made(made),
                Ok(Err(error)) => Making::Failed(error.to_string(), Instant::now()),
                Err(Failed) => {
                    let why = "The model cannot be drawn, which is a mistake of the program.";
                    Making::Failed(why.to_owned(), Instant::now())
                }
            };
        }
        match self {
            Making::Coming(_) => Ok(None),
            Making::Made(made) => Ok(Some(made.clone())),
            Making::Failed(why, _) => {
                context.request_repaint_after(AGAIN);
                Err(why.clone())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end<T: Clone + Send + 'static>(mut making: Making<T>) -> Result<T, String> {
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
        assert_eq!(end(Making::begin(&context, || Ok(7))), Ok(7));
        let lost = || {
            Err(EngineError::new(
                sabi_engine::ErrorKind::NoAdapter,
                "the device is lost",
            ))
        };
        assert_eq!(
            end(Making::<()>::begin(&context, lost)),
            Err("the device is lost".to_owned())
        );
        let failed = |ago| Making::<()>::Failed(String::new(), Instant::now() - ago);
        assert!(!failed(Duration::ZERO).is_stale() && failed(2 * AGAIN).is_stale());
        let panics = Making::<()>::begin(&context, || panic!("as this test wants"));
        assert!(end(panics).is_err_and(|why| why.contains("a mistake of the program")));
    }
}
