//! The environment, loaded on a thread of its own.

use std::path::Path;

use egui::Context;
use sabi_engine::EngineError;
use sabi_engine::opening::environment::{built_in_environments, load_environment};
use sabi_view::Environment;

use crate::evaluation::Evaluation;
use crate::task::{Task, TaskFailure};

type LoadedEnvironment = Result<(Environment, Vec<String>), EngineError>;

/// The shown environment, and the one that is being loaded.
pub(crate) struct EnvironmentLoader {
    choice: String,
    /// Choice that was loaded last.
    requested: Option<String>,
    loading: Option<Task<LoadedEnvironment>>,
    /// Tasks whose result is not needed any more, until they end.
    obsolete: Vec<Task<LoadedEnvironment>>,
    environment: Option<Environment>,
    number: u64,
    /// True if a built-in environment replaces an environment that could not be loaded.
    is_replacement: bool,
    /// Sentence about why the last choice is not shown.
    pub(super) fault: Option<String>,
}

impl EnvironmentLoader {
    pub(super) fn new(choice: &str) -> EnvironmentLoader {
        EnvironmentLoader {
            choice: choice.to_owned(),
            requested: None,
            loading: None,
            obsolete: Vec::new(),
            environment: None,
            number: 0,
            is_replacement: false,
            fault: None,
        }
    }

    /// Chosen environment: a built-in name, or a file.
    pub(super) fn choice(&self) -> &str {
        &self.choice
    }

    /// Chooses an environment: a built-in name, or a file.
    pub(crate) fn choose(&mut self, choice: &str) {
        self.is_replacement = false;
        choice.clone_into(&mut self.choice);
    }

    /// Chosen file; `None` for a built-in environment.
    pub(crate) fn file(&self) -> Option<&Path> {
        let is_own = built_in_environments().any(|own| own == self.choice);
        (!is_own).then(|| Path::new(&self.choice))
    }

    /// Loads the choice again. The shown environment stays until then, and if the file cannot be read.
    pub(crate) fn read_again(&mut self) {
        self.requested = None;
    }

    pub(super) fn environment(&self) -> Option<&Environment> {
        self.environment.as_ref()
    }

    /// Rises with every environment.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// Starts to load the chosen environment, and takes over a loaded one. Returns the error sentence if one could not be
    /// loaded. While there is no environment at all, a built-in one replaces it.
    pub(super) fn poll(&mut self, evaluation: &Evaluation, context: &Context) -> Option<String> {
        if self.requested.as_ref() != Some(&self.choice) {
            self.requested = Some(self.choice.clone());
            let (gpu, choice, cache) = (
                evaluation.gpu().clone(),
                self.choice.clone(),
                evaluation.cache_dir().map(ToOwned::to_owned),
            );
            self.obsolete.extend(self.loading.take());
            self.loading = Some(Task::start(context, move || {
                load_environment(&gpu, &choice, cache.as_deref())
            }));
        }
        self.obsolete.retain(|task| !task.is_over());
        let loaded = match self.loading.as_ref()?.poll()? {
            Ok(loaded) => loaded.map_err(|error| error.to_string()),
            Err(TaskFailure) => Err(format!("'{}' could not be read to its end", self.choice)),
        };
        self.loading = None;
        match loaded {
            Ok((environment, remarks)) => {
                self.environment = Some(environment);
                self.number += 1;
                self.fault = remarks
                    .into_iter()
                    .next()
                    .or(self.fault.take().filter(|_| self.is_replacement));
                None
            }
            Err(why) => {
                let first = built_in_environments().next();
                if let Some(first) = first.filter(|first| self.environment.is_none() && self.choice != *first) {
                    self.choose(first);
                    self.is_replacement = true;
                }
                self.fault = Some(why.clone());
                Some(why)
            }
        }
    }
}
