//! The light from all around, loaded beside the window.

use std::sync::mpsc::{Receiver, channel};
use std::thread;

use egui::Context;
use sabi_engine::view::Environment;
use sabi_engine::{EngineError, load_environment};

use crate::stage::Stage;

type Loaded = Result<(Environment, Vec<String>), EngineError>;

/// The environment that is shown, and the one that is on its way.
pub(super) struct Surroundings {
    choice: String,
    /// What was asked for last.
    asked: Option<String>,
    coming: Option<Receiver<Loaded>>,
    environment: Option<Environment>,
    number: u64,
    /// Why the last choice is not shown.
    pub(super) fault: Option<String>,
}

impl Surroundings {
    pub(super) fn new(choice: &str) -> Surroundings {
        Surroundings {
            choice: choice.to_owned(),
            asked: None,
            coming: None,
            environment: None,
            number: 0,
            fault: None,
        }
    }

    /// What was chosen: a built-in name, or a file.
    pub(super) fn choice(&self) -> &str {
        &self.choice
    }

    pub(super) fn choose(&mut self, choice: &str) {
        choice.clone_into(&mut self.choice);
    }

    pub(super) fn environment(&self) -> Option<&Environment> {
        self.environment.as_ref()
    }

    /// Another number for every environment.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// Begins to load what was chosen, and takes what has come.
    pub(super) fn poll(&mut self, stage: &Stage, context: &Context) {
        if self.asked.as_ref() != Some(&self.choice) {
            self.asked = Some(self.choice.clone());
            let (sender, coming) = channel();
            let (gpu, choice, cache) = (
                stage.gpu().clone(),
                self.choice.clone(),
                stage.cache_dir().map(ToOwned::to_owned),
            );
            let woken = context.clone();
            thread::spawn(move || {
                // Nobody waits any more where another was chosen meanwhile.
                let _ = sender.send(load_environment(&gpu, &choice, cache.as_deref()));
                woken.request_repaint();
            });
            self.coming = Some(coming);
        }
        let Some(loaded) = self.coming.as_ref().and_then(|coming| coming.try_recv().ok()) else {
            return;
        };
        self.coming = None;
        match loaded {
            Ok((environment, remarks)) => {
                self.environment = Some(environment);
                self.number += 1;
                self.fault = remarks.into_iter().next();
            }
            Err(error) => self.fault = Some(error.to_string()),
        }
    }
}
