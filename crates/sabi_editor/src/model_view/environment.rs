//! The light from all around, loaded beside the window.

use std::path::Path;

use egui::Context;
use sabi_engine::view::Environment;
use sabi_engine::{EngineError, built_in_environments, load_environment};

use crate::evaluation::Evaluation;
use crate::task::{Failed, Task};

type Loaded = Result<(Environment, Vec<String>), EngineError>;

/// The environment that is shown, and the one that is on its way.
pub(super) struct Surroundings {
    choice: String,
    /// What was asked for last.
    asked: Option<String>,
    coming: Option<Task<Loaded>>,
    /// Those that nobody waits for any more, as long as they are at work.
    former: Vec<Task<Loaded>>,
    environment: Option<Environment>,
    number: u64,
    /// Whether one stands in for another that could not be had.
    is_stand_in: bool,
    /// Why the last choice is not shown.
    pub(super) fault: Option<String>,
}

impl Surroundings {
    pub(super) fn new(choice: &str) -> Surroundings {
        Surroundings {
            choice: choice.to_owned(),
            asked: None,
            coming: None,
            former: Vec::new(),
            environment: None,
            number: 0,
            is_stand_in: false,
            fault: None,
        }
    }

    /// What was chosen: a built-in name, or a file.
    pub(super) fn choice(&self) -> &str {
        &self.choice
    }

    pub(super) fn choose(&mut self, choice: &str) {
        self.is_stand_in = false;
        choice.clone_into(&mut self.choice);
    }

    /// The file that was chosen; none where it is one of the program's own.
    pub(super) fn file(&self) -> Option<&Path> {
        let is_own = built_in_environments().any(|own| own == self.choice);
        (!is_own).then(|| Path::new(&self.choice))
    }

    /// Loads what was chosen once more; what is shown stays until then, and if it cannot be read any more.
    pub(super) fn read_again(&mut self) {
        self.asked = None;
    }

    pub(super) fn environment(&self) -> Option<&Environment> {
        self.environment.as_ref()
    }

    /// Another number for every environment.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// Begins to load what was chosen, and takes what has come. Gives the sentence for what cannot be had; while there is no
    /// environment at all, one that comes with the program takes its place.
    pub(super) fn poll(&mut self, evaluation: &Evaluation, context: &Context) -> Option<String> {
        if self.asked.as_ref() != Some(&self.choice) {
            self.asked = Some(self.choice.clone());
            let (gpu, choice, cache) = (
                evaluation.gpu().clone(),
                self.choice.clone(),
                evaluation.cache_dir().map(ToOwned::to_owned),
            );
            self.former.extend(self.coming.take());
            self.coming = Some(Task::start(context, move || {
                load_environment(&gpu, &choice, cache.as_deref())
            }));
        }
        self.former.retain(|task| !task.is_over());
        let loaded = match self.coming.as_ref()?.poll()? {
            Ok(loaded) => loaded.map_err(|error| error.to_string()),
            Err(Failed) => Err(format!("'{}' could not be read to its end", self.choice)),
        };
        self.coming = None;
        match loaded {
            Ok((environment, remarks)) => {
                self.environment = Some(environment);
                self.number += 1;
                self.fault = remarks
                    .into_iter()
                    .next()
                    .or(self.fault.take().filter(|_| self.is_stand_in));
                None
            }
            Err(why) => {
                let first = built_in_environments().next();
                if let Some(first) = first.filter(|first| self.environment.is_none() && self.choice != *first) {
                    self.choose(first);
                    self.is_stand_in = true;
                }
                self.fault = Some(why.clone());
                Some(why)
            }
        }
    }
}
