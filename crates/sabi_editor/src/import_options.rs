//! Options for reading a model's file, where the file leaves a choice or is wrong. They belong to the model and not to
//! the graph, which is tried on many models. A graph keeps only some of them, for its own model.

use std::ops::{Not, RangeInclusive};
use std::path::{Path, PathBuf};

use sabi_engine::opening::default_memory_bytes;
use sabi_engine::opening::linked_model::{ModelOptions, Overlap, SavedReading};
use sabi_files::TrustedPaths;
use sabi_surface::atlas::Udim;
use sabi_surface::load::{PartChoice, Up};
use serde::{Deserialize, Serialize};

/// Limits of the factor of lengths.
pub(crate) const SCALES: [f32; 2] = [1e-4, 1e4];
/// Smoothing angles, degrees.
pub(crate) const SMOOTH_ANGLES: RangeInclusive<f32> = 0.0..=180.0;
/// Smoothing angle to begin with: rounds facets, and keeps the edges of boxes.
pub(crate) const USUAL_SMOOTH_ANGLE: f32 = 40.0;
/// Highest UV set.
pub(crate) const LAST_UV: u32 = 7;
/// Highest scene.
pub(crate) const LAST_SCENE: u32 = 63;

/// Options for reading a model's file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct ImportOptions {
    /// Axis of the file that points up.
    #[serde(with = "UpSetting")]
    pub(crate) up: Up,
    /// UV set.
    pub(crate) uv: u32,
    /// Factor of all lengths.
    pub(crate) scale: f32,
    /// Angle between faces up to which their shading is smooth, degrees; `None` for the normals of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) smooth: Option<f32>,
    /// Scene of a glTF file; `None` for the one that the file names.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) scene: Option<u32>,
    /// Treatment of UVs in several tiles.
    #[serde(with = "TilesSetting")]
    pub(crate) udim: Udim,
    /// Treatment of charts that overlap in the UV set.
    #[serde(with = "OverlapSetting")]
    pub(crate) overlap: Overlap,
    /// Parts of the file that are used.
    #[serde(skip_serializing_if = "PartChoice::is_default")]
    pub(crate) parts: PartChoice,
    /// True to turn faces that are inside out.
    #[serde(skip_serializing_if = "Not::not")]
    pub(crate) turn_faces: bool,
    /// Folder that is searched, with the folders below it, for missing files that the model names.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) textures: Option<PathBuf>,
}

impl Default for ImportOptions {
    fn default() -> ImportOptions {
        ImportOptions {
            up: Up::Y,
            uv: 0,
            scale: 1.0,
            smooth: None,
            scene: None,
            udim: Udim::Auto,
            overlap: Overlap::Auto,
            parts: PartChoice::default(),
            turn_faces: false,
            textures: None,
        }
    }
}

impl ImportOptions {
    /// Options with all values within their limits, since settings may have been edited by hand.
    pub(crate) fn sanitized(self) -> ImportOptions {
        let [least, most] = SCALES;
        ImportOptions {
            uv: self.uv.min(LAST_UV),
            scale: if self.scale.is_finite() {
                self.scale.clamp(least, most)
            } else {
                1.0
            },
            smooth: self.smooth.filter(|degrees| SMOOTH_ANGLES.contains(degrees)),
            scene: self.scene.map(|scene| scene.min(LAST_SCENE)),
            ..self
        }
    }

    /// Options that the graph keeps for its own model.
    pub(crate) fn saved(&self) -> SavedReading {
        SavedReading {
            parts: self.parts.clone(),
            turn_faces: self.turn_faces.then_some(true),
            textures: self.textures.clone(),
        }
    }

    /// These options, with those that the graph keeps replaced by `saved`.
    pub(crate) fn with_saved(self, saved: SavedReading) -> ImportOptions {
        let SavedReading {
            parts,
            turn_faces,
            textures,
        } = saved;
        ImportOptions {
            parts,
            turn_faces: turn_faces == Some(true),
            textures,
            ..self
        }
    }

    /// Engine options for a file at a size.
    pub(crate) fn options(
        &self,
        file: &Path,
        trusted: &TrustedPaths,
        size: u32,
        cache_dir: Option<&Path>,
    ) -> ModelOptions {
        ModelOptions {
            path: file.to_owned(),
            uv: self.uv,
            up: self.up,
            scale: self.scale,
            scene: self.scene,
            smooth_degrees: self.smooth,
            reading: self.saved(),
            overlap: self.overlap,
            udim: self.udim,
            size,
            cache_dir: cache_dir.map(Path::to_owned),
            trusted: trusted.clone(),
            memory_bytes: default_memory_bytes(),
        }
    }
}

/// [`Up`] as settings name it.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Up", rename_all = "snake_case")]
enum UpSetting {
    Y,
    Z,
    X,
}

/// [`Udim`] as settings name it.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Udim", rename_all = "snake_case")]
enum TilesSetting {
    Auto,
    On,
    Off,
}

/// [`Overlap`] as settings name it.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Overlap", rename_all = "snake_case")]
enum OverlapSetting {
    Auto,
    First,
    Merge,
    Unwrap,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_settings_are_read_and_brought_within_their_limits() {
        let read = |text: &str| {
            serde_json::from_str::<ImportOptions>(text)
                .map(ImportOptions::sanitized)
                .ok()
        };
        let odd = ImportOptions {
            up: Up::Z,
            uv: 1,
            scale: 0.01,
            smooth: Some(30.0),
            scene: Some(2),
            udim: Udim::On,
            overlap: Overlap::Merge,
            parts: PartChoice {
                parts: Vec::new(),
                without: vec!["Hull".into()],
            },
            turn_faces: true,
            textures: Some(PathBuf::from("pictures")),
        };
        let text = serde_json::to_string(&odd).expect("text");
        assert_eq!(
            text,
            r#"{"up":"z","uv":1,"scale":0.01,"smooth":30.0,"scene":2,"udim":"on","overlap":"merge","parts":{"without":["Hull"]},"turn_faces":true,"textures":"pictures"}"#
        );
        assert_eq!(read(&text), Some(odd));
        assert_eq!(read("{}"), Some(ImportOptions::default()));
        let wild = read(r#"{ "uv": 99, "scale": -3, "smooth": 900 }"#).expect("a reading");
        assert_eq!((wild.uv, wild.scale, wild.smooth), (LAST_UV, SCALES[0], None));
    }
}
