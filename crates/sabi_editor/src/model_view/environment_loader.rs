//! The environment, loaded on a thread of its own.

use std::path::Path;

use egui::Context;
use sabi_engine::view::Environment;
use sabi_engine::{EngineError, built_in_environments, load_environment};

use crate::evaluation::Evaluation;
use crate::task::{Failed, Task};

type Loaded = Result<(Environment, Vec<String>), EngineError>;

/// The shown environment, and the one that is being loaded.
pub(super) struct EnvironmentLoader {
    choice: String,
    /// Choice that was loaded last.
    asked: Option<String>,
    coming: Option<Task<Loaded>>,
    /// Tasks whose result is not needed any more, until they end.
    former: Vec<Task<Loaded>>,
    environment: Option<Environment>,
    number: u64,
    /// Whether a built-in environment replaces one that could not be loaded.
    is_stand_in: bool,
    /// Sentence about why the last choice is not shown.
    pub(super) fault: Option<String>,
}

impl EnvironmentLoader {
    pub(super) fn new(choice: &str) -> EnvironmentLoader {
        EnvironmentLoader {
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

    /// Chosen environment: a built-in name, or a file.
    pub(super) fn choice(&self) -> &str {
        &self.choice
    }

    pub(super) fn choose(&mut self, choice: &str) {
        self.is_stand_in = false;
        choice.clone_into(&mut self.choice);
    }

    /// Chosen file; none for a built-in environment.
    pub(super) fn file(&self) -> Option<&Path> {
        let is_own = built_in_environments().any(|own| own == self.choice);
        (!is_own).then(|| Path::new(&self.choice))
    }

    /// Loads the choice again. The shown environment stays until then, and if the file cannot be read.
    pub(super) fn read_again(&mut self) {
        self.asked = None;
    }

    pub(super) fn environment(&self) -> Option<&Environment> {
        self.environment.as_ref()
    }

    /// Rises with every environment.
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
