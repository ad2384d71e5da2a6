//! Model that results are evaluated on: its import options, and the received model.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_engine::live::LiveModel;
use sabi_engine::opening::linked_model::ModelOptions;
use sabi_engine::{EngineError, Warning};
use sabi_files::TrustedPaths;
use sabi_surface::model::FilePart;

use crate::import_options::ImportOptions;

/// Outcome of a request for another model.
pub(crate) enum ModelOutcome {
    /// It is shown.
    Shown,
    /// It cannot be shown, and the one before it is requested again.
    Refused {
        /// File of the model.
        file: PathBuf,
        error: EngineError,
    },
}

/// Requested model, received model and error.
pub(crate) struct RequestedModel {
    pub(super) options: Arc<ModelOptions>,
    import: ImportOptions,
    cache_dir: Option<PathBuf>,
    /// Paths from which the model may open the files that it names.
    trusted: TrustedPaths,
    /// Revision of the options: another one after every change.
    pub(super) revision: u64,
    /// First revision with this file and these options, whatever their size.
    file_since: u64,
    /// Highest revision so far.
    last_revision: u64,
    /// Request that the received model belongs to.
    good: Option<Good>,
    /// File that could not be shown, until another one is requested.
    refused: Option<PathBuf>,
    /// Outcome of the last request, until it is taken.
    outcome: Option<ModelOutcome>,
    /// Highest-resolution model received so far.
    pub(crate) received: Option<Arc<LiveModel>>,
    /// Error of the last attempt to read the model.
    pub(crate) failure: Option<EngineError>,
}

/// Request that was answered with a model.
struct Good {
    options: Arc<ModelOptions>,
    import: ImportOptions,
    revision: u64,
    file_since: u64,
}

impl RequestedModel {
    pub(super) fn new(file: &Path, import: ImportOptions, size: u32, cache_dir: Option<&Path>) -> RequestedModel {
        let trusted = TrustedPaths::default();
        RequestedModel {
            options: Arc::new(import.options(file, &trusted, size, cache_dir)),
            trusted,
            import,
            cache_dir: cache_dir.map(Path::to_owned),
            revision: 0,
            file_since: 0,
            last_revision: 0,
            good: None,
            refused: None,
            outcome: None,
            received: None,
            failure: None,
        }
    }

    /// File of the model.
    pub(crate) fn file(&self) -> &Path {
        &self.options.path
    }

    /// Warnings about the requested model at its full size. There are none about the coarse model, since its size was
    /// not requested, and none while another model is being read.
    pub(crate) fn warnings(&self) -> &[Warning] {
        let is_requested = |model: &&Arc<LiveModel>| model.model_revision >= self.file_since;
        let full = self.received.as_ref().filter(|model| model.size == self.size());
        let full = full.filter(is_requested);
        full.map_or(&[], |model| &model.warnings)
    }

    /// Texels along a side of full-resolution results.
    pub(crate) fn size(&self) -> u32 {
        self.options.size
    }

    /// Options for reading the file.
    pub(crate) fn import_options(&self) -> &ImportOptions {
        &self.import
    }

    /// Parts that the file has, as far as it was read.
    pub(crate) fn file_parts(&self) -> &[FilePart] {
        let of_file = self.good.as_ref().filter(|good| good.options.path == self.options.path);
        let model = of_file.and(self.received.as_ref());
        model.map_or(&[], |model| &model.linked.model.file_parts)
    }

    /// Options for reading the model at a size, texels.
    pub(crate) fn options_of_size(&self, size: u32) -> ModelOptions {
        self.import
            .options(self.file(), &self.trusted, size, self.cache_dir.as_deref())
    }

    /// Revision of the model since which the requested file and the way of reading it are the same, at any size.
    pub(crate) fn file_since(&self) -> u64 {
        self.file_since
    }

    /// Revision of the received model, and whether it is the requested one.
    pub(crate) fn loaded(&self) -> (Option<u64>, bool) {
        let loaded = self.received.as_ref().map(|model| model.model_revision);
        (loaded, loaded == Some(self.revision))
    }

    /// Requests another model, or the same one with other options.
    pub(crate) fn replace(&mut self, file: &Path, import: ImportOptions) {
        // A substitute for another model is still one when it is read again.
        if file != self.file() {
            self.refused = None;
        }
        self.set_options(import.options(file, &self.trusted, self.size(), self.cache_dir.as_deref()));
        self.file_since = self.revision;
        self.import = import;
        self.failure = None;
    }

    /// Requests the model again, since its file changed.
    pub(crate) fn reread(&mut self) {
        let file = self.file().to_owned();
        self.replace(&file, self.import.clone());
    }

    /// Requests the model at a size, texels.
    pub(super) fn set_size(&mut self, size: u32) {
        if size != self.size() {
            self.set_options(self.options_of_size(size));
        }
    }

    /// Lets the model open the files that it names below these paths. It is read again if that may give another result.
    pub(super) fn set_trusted(&mut self, trusted: &TrustedPaths) {
        if self.trusted == *trusted {
            return;
        }
        self.trusted = trusted.clone();
        let is_whole = |model: &Arc<LiveModel>| model.linked.model.refused.is_empty();
        let options = self.options_of_size(self.size());
        match self.received.as_ref().is_some_and(is_whole) && self.failure.is_none() {
            true => self.options = Arc::new(options),
            false => {
                self.failure = None;
                self.set_options(options);
            }
        }
    }

    fn set_options(&mut self, options: ModelOptions) {
        self.options = Arc::new(options);
        self.last_revision += 1;
        self.revision = self.last_revision;
    }

    /// Returns whether the requested model is being read while another one is there to be shown.
    pub(crate) fn is_replacing(&self) -> bool {
        let is_another = |good: &Good| good.file_since != self.file_since;
        self.failure.is_none() && self.good.as_ref().is_some_and(is_another)
    }

    /// Requests the previous model again in place of the one that is being read. Returns the previous model's file and
    /// import options; `None` if there is no previous model.
    pub(crate) fn cancel(&mut self) -> Option<(PathBuf, ImportOptions)> {
        if !self.is_replacing() {
            return None;
        }
        let left = self.file().to_owned();
        self.return_to_good();
        let is_another = self.file() != left;
        self.refused = is_another.then_some(left);
        Some((self.file().to_owned(), self.import.clone()))
    }

    /// Returns whether the requested model is being read and is the first one.
    pub(crate) fn is_first(&self) -> bool {
        self.failure.is_none() && self.good.is_none()
    }

    /// Requests another model in place of the first one, which is being read.
    pub(crate) fn cancel_first(&mut self, instead: &Path, import: ImportOptions) {
        let left = self.file().to_owned();
        self.replace(instead, import);
        self.refused = Some(left);
    }

    /// Returns whether a model is being read in this way already, so that requesting it again would only restart it.
    pub(crate) fn is_being_read(&self, file: &Path, import: &ImportOptions) -> bool {
        (self.is_replacing() || self.is_first()) && self.file() == file && self.import == *import
    }

    /// Requests the last model again that could be shown.
    fn return_to_good(&mut self) {
        if let Some(good) = &self.good {
            self.options = good.options.clone();
            self.import = good.import.clone();
            self.revision = good.revision;
            self.file_since = good.file_since;
        }
    }

    /// File that could not be shown, where the model before it is shown instead.
    pub(crate) fn refused(&self) -> Option<&Path> {
        self.refused.as_deref()
    }

    /// Takes the outcome of the last request.
    pub(crate) fn take_outcome(&mut self) -> Option<ModelOutcome> {
        self.outcome.take()
    }

    /// Takes the model or the error of a revision, unless another revision was requested since. If a new file cannot be
    /// shown and there is no remedy, the previous model is requested again.
    pub(super) fn receive(&mut self, revision: u64, read: Result<Arc<LiveModel>, EngineError>) {
        if revision != self.revision {
            return;
        }
        match read {
            Ok(model) => {
                self.failure = None;
                self.received = Some(model);
                self.good = Some(Good {
                    options: self.options.clone(),
                    import: self.import.clone(),
                    revision,
                    file_since: self.file_since,
                });
                self.outcome = Some(ModelOutcome::Shown);
            }
            Err(error) => match &self.good {
                Some(good) if good.options.path != self.options.path && error.remedies.is_empty() => {
                    let file = self.file().to_owned();
                    self.return_to_good();
                    self.refused = Some(file.clone());
                    self.outcome = Some(ModelOutcome::Refused { file, error });
                }
                _ => self.failure = Some(error),
            },
        }
    }
}
