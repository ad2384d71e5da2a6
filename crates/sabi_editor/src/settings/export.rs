//! Choices of the export panel, as they are kept between runs.

use std::path::{Path, PathBuf};

use sabi_engine::baking::{DEFAULT_PRESET, default_padding, export_channels};
use sabi_export::CopyOptions;

/// Sizes that the panel offers.
pub(crate) const SIZES: [u32; 6] = [256, 512, 1024, 2048, 4096, 8192];

/// Choices of the export panel, kept between runs.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct ExportChoices {
    pub(crate) preset: String,
    /// Texels along a side.
    pub(crate) size: u32,
    /// Pattern of file names; empty for the default.
    pub(crate) names: String,
    /// Channels that are exported; empty for all.
    pub(crate) channels: Vec<String>,
    /// Padding around the UV islands.
    pub(crate) padding: ExportPadding,
    pub(crate) has_model: bool,
    /// True if the copy of the model keeps the parts of its materials that the textures do not replace.
    pub(crate) keeps_look: bool,
    /// True if the copy of the model is one file with the maps in it.
    pub(crate) embeds: bool,
    pub(crate) all_maps: bool,
}

/// Padding around the UV islands of exported textures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ExportPadding {
    /// The width that the mip levels of game engines need at the size of the texture.
    #[default]
    Automatic,
    /// A number of texels.
    Texels(u32),
    /// Everything around the islands is filled.
    Everything,
}

impl ExportPadding {
    /// Paddings that the panel offers.
    pub(crate) const OFFERED: [ExportPadding; 8] = [
        ExportPadding::Automatic,
        ExportPadding::Texels(0),
        ExportPadding::Texels(2),
        ExportPadding::Texels(4),
        ExportPadding::Texels(8),
        ExportPadding::Texels(16),
        ExportPadding::Texels(32),
        ExportPadding::Everything,
    ];

    /// Width in texels at a size; `None` to fill everything.
    pub(crate) fn texels(self, size: u32) -> Option<u32> {
        match self {
            ExportPadding::Automatic => Some(default_padding(size)),
            ExportPadding::Texels(texels) => Some(texels),
            ExportPadding::Everything => None,
        }
    }

    /// Text of a choice at a size.
    pub(crate) fn text(self, size: u32) -> String {
        match self {
            ExportPadding::Automatic => format!("Automatic ({} px)", default_padding(size)),
            ExportPadding::Texels(texels) => format!("{texels} px"),
            ExportPadding::Everything => "Fill everything".to_owned(),
        }
    }
}

impl Default for ExportChoices {
    fn default() -> ExportChoices {
        ExportChoices {
            preset: DEFAULT_PRESET.to_owned(),
            size: 2048,
            names: String::new(),
            channels: Vec::new(),
            padding: ExportPadding::default(),
            has_model: false,
            keeps_look: false,
            embeds: false,
            all_maps: false,
        }
    }
}

impl ExportChoices {
    /// Options of the copy of the model; `None` without one.
    pub(crate) fn copy_options(&self) -> Option<CopyOptions> {
        self.has_model.then_some(CopyOptions {
            keeps_look: self.keeps_look,
            embeds: self.embeds,
        })
    }

    /// Choices with unknown values replaced by the default, since settings may have been edited by hand.
    pub(crate) fn sanitized(mut self) -> ExportChoices {
        let usual = ExportChoices::default();
        if self.preset.is_empty() {
            self.preset = usual.preset;
        }
        if !SIZES.contains(&self.size) {
            self.size = usual.size;
        }
        if !ExportPadding::OFFERED.contains(&self.padding) {
            self.padding = usual.padding;
        }
        let known = export_channels();
        self.channels.retain(|channel| known.contains(channel));
        self
    }
}

/// Target of the textures of a graph, kept between runs.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub(crate) struct ExportPlace {
    pub(crate) folder: String,
    /// True if the textures are exported again at every save.
    pub(crate) again: bool,
    /// True if the base and every variant are exported, each to a folder of its own in the folder.
    pub(crate) variants: bool,
    /// Model that the textures in the folder were exported for.
    #[serde(with = "sabi_files::path_encoding::optional")]
    pub(crate) model: Option<PathBuf>,
}

impl ExportPlace {
    /// Target of a graph's textures, with a folder beside the graph where none was chosen.
    pub(crate) fn beside(mut self, graph: &Path) -> ExportPlace {
        if let Some(stem) = graph.file_stem().filter(|_| self.folder.is_empty()) {
            self.folder = format!("{}-textures", stem.to_string_lossy());
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_beside_the_graph_is_proposed_until_one_is_chosen() {
        let graph = Path::new("props/worn crate.sabi");
        let proposed = ExportPlace::default().beside(graph);
        assert_eq!(proposed.folder, "worn crate-textures");
        let chosen = ExportPlace {
            folder: "maps".to_owned(),
            ..ExportPlace::default()
        };
        assert_eq!(chosen.clone().beside(graph), chosen);
    }

    #[test]
    fn a_padding_is_as_wide_as_it_says() {
        let widths = [
            ExportPadding::Automatic,
            ExportPadding::Texels(3),
            ExportPadding::Everything,
        ];
        assert_eq!(widths.map(|padding| padding.texels(2048)), [Some(16), Some(3), None]);
        assert_eq!(ExportPadding::Automatic.text(2048), "Automatic (16 px)");
    }

    #[test]
    fn unknown_choices_are_replaced_by_the_default() {
        let choices = ExportChoices {
            preset: String::new(),
            size: 1000,
            padding: ExportPadding::Texels(9),
            channels: vec!["normal".to_owned(), "smell".to_owned()],
            ..ExportChoices::default()
        };
        let channels = vec!["normal".to_owned()];
        let expected = ExportChoices {
            channels,
            ..ExportChoices::default()
        };
        assert_eq!(choices.sanitized(), expected);
    }
}
