//! A picture of the view at any size, drawn one sample in each frame, and written to a file.

use std::path::PathBuf;
use std::sync::Arc;

use sabi_engine::rendering::encode_picture;
use sabi_files::write_whole;
use sabi_gpu::Gpu;
use sabi_view::{Background, Mode, Pixels, Viewport};

use super::ModelView;
use super::model_view_pictures::Lighting;
use super::painting::shot_of;
use crate::evaluation::ResultPicture;

/// Samples of a saved picture.
const SAMPLES: u32 = 16;
/// Sizes that are offered, pixels.
pub(super) const SIZES: [[u32; 2]; 5] = [[1280, 720], [1920, 1080], [2048, 2048], [3840, 2160], [4096, 4096]];
/// Largest side that can be typed, pixels.
pub(super) const LARGEST: u32 = 8192;

/// Picture that is being drawn.
struct PictureInProgress {
    file: PathBuf,
    viewport: Viewport,
}

/// Size of saved pictures, and the one that is being drawn.
pub(crate) struct SavedPicture {
    /// Width and height, pixels.
    pub(crate) size: [u32; 2],
    /// File for the next picture.
    wanted: Option<PathBuf>,
    drawn: Option<PictureInProgress>,
}

impl Default for SavedPicture {
    fn default() -> SavedPicture {
        SavedPicture {
            size: SIZES[1],
            wanted: None,
            drawn: None,
        }
    }
}

impl SavedPicture {
    /// Draws a picture of the view and writes it to a file.
    pub(crate) fn save_to(&mut self, file: PathBuf) {
        self.wanted = Some(file);
    }

    /// Returns whether a picture is being drawn.
    pub(crate) fn is_busy(&self) -> bool {
        self.wanted.is_some() || self.drawn.is_some()
    }
}

impl ModelView {
    /// Draws the next sample of the picture that is saved, if one is. Returns a sentence once it is written or has failed.
    pub(super) fn advance_saved_picture(&mut self, gpu: &Arc<Gpu>, picture: &ResultPicture) -> Option<String> {
        if let Some(file) = self.saved_picture.wanted.take() {
            match self.pictures.new_viewport(gpu) {
                Some(viewport) => self.saved_picture.drawn = Some(PictureInProgress { file, viewport }),
                // The renderer is still being made.
                None => self.saved_picture.wanted = Some(file),
            }
        }
        let mut drawn = self.saved_picture.drawn.take()?;
        let shot = shot_of(self.navigation.camera, &self.shot, picture, Mode::Node);
        let shot = sabi_view::Shot {
            samples: SAMPLES,
            ..shot
        };
        let lighting = Lighting::of(&self.environment, &self.lights);
        match lighting.draw(gpu, &mut drawn.viewport, picture, &shot, self.saved_picture.size) {
            Ok(true) => {
                self.saved_picture.drawn = Some(drawn);
                None
            }
            Ok(false) => Some(written(gpu, &drawn, self.shot.background == Background::Clear)),
            Err(error) => Some(format!("The picture could not be drawn: {error}")),
        }
    }
}

/// Writes a finished picture. Returns a sentence about the file, or about why it could not be written.
fn written(gpu: &Gpu, drawn: &PictureInProgress, with_alpha: bool) -> String {
    let file = drawn.file.display();
    let Some(target) = drawn.viewport.picture() else {
        return format!("There is nothing to write to {file}: the model is not shown yet.");
    };
    let bytes = target.read(gpu).map_err(|error| error.to_string());
    let bytes = bytes.and_then(|pixels: Pixels| encode_picture(&pixels, with_alpha).map_err(|error| error.to_string()));
    let saved = bytes.and_then(|bytes| write_whole(&drawn.file, &bytes).map_err(|error| error.to_string()));
    match saved {
        Ok(()) => format!("Saved the picture to {file}"),
        Err(why) => format!("The picture could not be saved: {why}"),
    }
}
