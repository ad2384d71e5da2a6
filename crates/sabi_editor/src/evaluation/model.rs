//! Model that results are evaluated on: how it is read, and what was received of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_engine::{EngineError, LiveModel, ModelOptions};

use crate::import_options::ImportOptions;

/// Requested model, received model and error.
pub(crate) struct RequestedModel {
    pub(super) options: Arc<ModelOptions>,
    import: ImportOptions,
    cache_dir: Option<PathBuf>,
    /// Rises with every change of the options.
    pub(super) revision: u64,
    /// Highest-resolution model received so far.
    pub(crate) received: Option<Arc<LiveModel>>,
    /// Error of the last attempt to read the model.
    pub(crate) failure: Option<EngineError>,
}

impl RequestedModel {
    pub(super) fn new(file: &Path, import: ImportOptions, size: u32, cache_dir: Option<&Path>) -> RequestedModel {
        RequestedModel {
            options: Arc::new(import.options(file, size, cache_dir)),
            import,
            cache_dir: cache_dir.map(Path::to_owned),
            revision: 0,
            received: None,
            failure: None,
        }
    }

    /// File of the model.
    pub(crate) fn file(&self) -> &Path {
        &self.options.path
    }

    /// Texels along a side of full-resolution results.
    pub(crate) fn size(&self) -> u32 {
        self.options.size
    }

    /// Options for reading the file.
    pub(crate) fn import_options(&self) -> ImportOptions {
        self.import
    }

    /// Options for reading the model at a size, texels.
    pub(crate) fn options_of_size(&self, size: u32) -> ModelOptions {
        self.import.options(self.file(), size, self.cache_dir.as_deref())
    }

    /// Revision of the received model, and whether it is the requested one.
    pub(crate) fn loaded(&self) -> (Option<u64>, bool) {
        let loaded = self.received.as_ref().map(|model| model.model_revision);
        (loaded, loaded == Some(self.revision))
    }

    /// Requests another model, or the same one with other options.
    pub(crate) fn replace(&mut self, file: &Path, import: ImportOptions) {
        self.options = Arc::new(import.options(file, self.size(), self.cache_dir.as_deref()));
        self.import = import;
        self.revision += 1;
        self.failure = None;
    }

    /// Requests the model again, since its file changed.
    pub(crate) fn reread(&mut self) {
        let file = self.file().to_owned();
        self.replace(&file, self.import);
    }

    /// Requests the model at a size, texels.
    pub(super) fn set_size(&mut self, size: u32) {
        if size != self.size() {
            self.options = Arc::new(self.options_of_size(size));
            self.revision += 1;
        }
    }

    /// Takes over what was read for a revision, unless another one is requested since.
    pub(super) fn receive(&mut self, revision: u64, read: Result<Arc<LiveModel>, EngineError>) {
        if revision != self.revision {
            return;
        }
        match read {
            Ok(model) => {
                self.failure = None;
                self.received = Some(model);
            }
            Err(error) => self.failure = Some(error),
        }
    }
}
