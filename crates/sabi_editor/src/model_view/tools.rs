//! What pictures of the model are drawn with, made beside the window.

use std::sync::Arc;

use egui::Context;
use sabi_engine::view::{Missing, Renderer};
use sabi_engine::{EngineError, Gpu};

use crate::errand::{Errand, Failed};

/// A renderer for all screens, and what it still needs.
#[derive(Default)]
pub(super) struct Tools {
    renderer: Option<Making<Arc<Renderer>>>,
    pipelines: Option<(Missing, Making<()>)>,
}

/// Something that is made on a thread of its own. It is not tried again: what fails once would fail in every frame.
enum Making<T> {
    Coming(Errand<Result<T, EngineError>>),
    Over(Result<T, String>),
}

impl Tools {
    /// The renderer, once it is made.
    pub(super) fn renderer(&mut self, context: &Context, gpu: &Arc<Gpu>) -> Result<Option<Arc<Renderer>>, String> {
        let begin = || {
            let gpu = gpu.clone();
            Making::begin(context, move || Ok(Arc::new(Renderer::new(&gpu)?)))
        };
        self.renderer.get_or_insert_with(begin).poll()
    }

    /// Whether nothing is missing any more; begins to make it otherwise. What another screen misses comes one after the other.
    pub(super) fn is_ready(
        &mut self,
        context: &Context,
        (gpu, renderer): (&Arc<Gpu>, &Arc<Renderer>),
        missing: Option<Missing>,
    ) -> Result<bool, String> {
        let Some(missing) = missing else { return Ok(true) };
        if let Some((known, making)) = &mut self.pipelines {
            let made = making.poll();
            if *known == missing {
                return Ok(made?.is_some());
            }
            if matches!(making, Making::Coming(_)) {
                return Ok(false);
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
        Making::Coming(Errand::start(context, make))
    }

    /// What was made, once it is.
    fn poll(&mut self) -> Result<Option<T>, String> {
        if let Making::Coming(errand) = self
            && let Some(come) = errand.poll()
        {
            *self = Making::Over(match come {
                Ok(made) => made.map_err(|error| error.to_string()),
                Err(Failed) => Err("The model cannot be drawn, which is a mistake of the program.".to_owned()),
            });
        }
        match self {
            Making::Coming(_) => Ok(None),
            Making::Over(made) => made.clone().map(Some),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end<T: Clone + Send + 'static>(mut making: Making<T>) -> Result<T, String> {
        loop {
            if let Some(made) = making.poll().transpose() {
                return made;
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn what_cannot_be_made_is_said_in_every_frame_and_not_tried_again() {
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
        let panics = Making::<()>::begin(&context, || panic!("as this test wants"));
        assert!(end(panics).is_err_and(|why| why.contains("a mistake of the program")));
    }
}
