//! How a model's file is read, where the file leaves it open or says something else than one wants. That is the model's and
//! not the graph's: a graph is tried on many.

use std::path::Path;

use sabi_engine::{ModelOptions, Overlap, Up};
use serde::{Deserialize, Serialize};

/// Lengths of a file are multiplied by no less and no more.
pub(crate) const SCALES: [f32; 2] = [1e-4, 1e4];
/// The highest UV set that is asked for.
pub(crate) const LAST_UV: u32 = 7;

/// How a model's file is read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Reading {
    /// Which axis of the file points up.
    #[serde(with = "Axis")]
    pub(crate) up: Up,
    /// Which UV set.
    pub(crate) uv: u32,
    /// All lengths are multiplied by this.
    pub(crate) scale: f32,
    /// What charts that share a place on the maps get.
    #[serde(with = "Sharing")]
    pub(crate) overlap: Overlap,
}

impl Default for Reading {
    fn default() -> Reading {
        Reading {
            up: Up::Y,
            uv: 0,
            scale: 1.0,
            overlap: Overlap::First,
        }
    }
}

impl Reading {
    /// What of it can be used: files of settings may have been written by hand.
    pub(crate) fn sound(self) -> Reading {
        let [least, most] = SCALES;
        Reading {
            uv: self.uv.min(LAST_UV),
            scale: if self.scale.is_finite() {
                self.scale.clamp(least, most)
            } else {
                1.0
            },
            ..self
        }
    }

    /// A file that is read so, at a size.
    pub(crate) fn options(self, file: &Path, size: u32, cache_dir: Option<&Path>) -> ModelOptions {
        ModelOptions {
            path: file.to_owned(),
            uv: self.uv,
            up: self.up,
            scale: self.scale,
            overlap: self.overlap,
            size,
            cache_dir: cache_dir.map(Path::to_owned),
        }
    }
}

/// [`Up`] as settings name it.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Up", rename_all = "snake_case")]
enum Axis {
    Y,
    Z,
    X,
}

/// [`Overlap`] as settings name it.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Overlap", rename_all = "snake_case")]
enum Sharing {
    First,
    Merge,
    Unwrap,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_settings_say_is_read_and_mended() {
        let read = |text: &str| serde_json::from_str::<Reading>(text).map(Reading::sound).ok();
        let odd = Reading {
            up: Up::Z,
            uv: 1,
            scale: 0.01,
            overlap: Overlap::Merge,
        };
        let text = serde_json::to_string(&odd).expect("text");
        assert_eq!(text, r#"{"up":"z","uv":1,"scale":0.01,"overlap":"merge"}"#);
        assert_eq!(read(&text), Some(odd));
        assert_eq!(read("{}"), Some(Reading::default()));
        let wild = read(r#"{ "uv": 99, "scale": -3 }"#).expect("a reading");
        assert_eq!((wild.uv, wild.scale), (LAST_UV, SCALES[0]));
    }
}
