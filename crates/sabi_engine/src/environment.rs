//! TEMP
use crate::error::EngineError;
use sabi_view::{Environment, Panorama};
use std::path::{Path, PathBuf};
pub(crate) struct LoadedEnvironment {
    pub(crate) warnings: Vec<String>,
    pub(crate) file: Option<PathBuf>,
    panorama: Panorama,
}
impl LoadedEnvironment {
    pub(crate) fn on(&self, gpu: &sabi_gpu::Gpu, _c: Option<&Path>) -> Result<Environment, EngineError> {
        Ok(Environment::new(gpu, &self.panorama)?)
    }
}
pub(crate) fn load_environment(name: &str) -> Result<LoadedEnvironment, EngineError> {
    let bytes = std::fs::read(name).unwrap_or_default();
    let picture = sabi_image::decode(name, &bytes)
        .map_err(|e| EngineError::new(crate::error::ErrorKind::BadInput, e))?
        .linear_rgba(false);
    let (panorama, warnings) = Panorama::new(picture.width, picture.height, &picture.rgba)?;
    Ok(LoadedEnvironment {
        warnings,
        file: None,
        panorama,
    })
}
