//! The font of texts that the brush stamps, as it is kept between runs.

use std::path::PathBuf;

use crate::paths::file_stem;

/// Font of texts that the brush stamps: that of the window, one whose letters are of one width, or the first one of a file.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct TextFont {
    /// True for the font whose letters are of one width.
    pub(crate) is_monospace: bool,
    #[serde(with = "sabi_files::path_encoding::optional")]
    pub(crate) file: Option<PathBuf>,
}

impl TextFont {
    /// The font whose letters are of one width.
    pub(crate) fn monospace() -> TextFont {
        TextFont {
            is_monospace: true,
            file: None,
        }
    }

    /// The first font of a file.
    pub(crate) fn of_file(file: PathBuf) -> TextFont {
        TextFont {
            is_monospace: false,
            file: Some(file),
        }
    }

    /// Title in the list of fonts.
    pub(crate) fn title(&self) -> String {
        match &self.file {
            Some(file) => file_stem(file).into_owned(),
            None if self.is_monospace => "Monospace".to_owned(),
            None => "Plain".to_owned(),
        }
    }
}
