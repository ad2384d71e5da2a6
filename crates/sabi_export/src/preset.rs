//! Presets: the files of a texture set as data.

mod builtin;
mod component;
mod document;
mod outputs;
mod read;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

pub use builtin::{BUILTIN_NAMES, builtin, builtin_text, raw};
pub use document::DocumentFormat;
pub use read::PresetError;

use crate::name_pattern::{NameParts, NamePattern};
use crate::{Channel, OutputKind};

/// Assignment of channels to files.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// Name on the command line.
    pub name: String,
    /// Description, a sentence.
    pub about: String,
    /// Direction of green in its normal maps.
    pub normal_y: NormalY,
    /// Pattern of the names of its files; see [`NamePattern::parse`].
    pub names: String,
    /// Its files, in the order of writing.
    pub maps: Vec<Map>,
    /// Documents of materials that are written beside the maps.
    pub documents: Vec<DocumentFormat>,
}

/// Direction that green of a normal map means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalY {
    /// Upward in the map, as OpenGL and glTF have it.
    #[default]
    Up,
    /// Downward, as DirectX has it.
    Down,
}

/// Kind of file of a preset.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Word for it in file names; unused for [`MapContent::Every`], whose files have the names of the outputs.
    pub name: String,
    /// Content of the file.
    pub content: MapContent,
    /// Encoding of the file.
    pub format: MapFormat,
    /// True if colors go through the sRGB curve; the file says so.
    pub is_srgb: bool,
    /// True if gradients in integer files are dithered. Areas of constant value never are.
    pub is_dithered: bool,
    /// True if the file contains 0 to 1 whatever the range of its channel: heights span their range, also in float files,
    /// and emission above 1 is divided by its highest value. The report contains range and divisor.
    pub is_normalized: bool,
    /// Size of the file.
    pub size: MapSize,
    /// Condition for writing it.
    pub when: When,
}

/// Content of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum MapContent {
    /// Up to four components: gray, gray and alpha, RGB, RGBA.
    Packed(Vec<Component>),
    /// Each output of the graph of one kind, a file for each.
    Every(OutputKind),
}

/// Component of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Source of its values.
    pub source: ComponentSource,
    /// True for 1 minus the value. A height, which has a range, is turned upside down within that range.
    pub is_inverted: bool,
}

/// Source of a component's values.
#[derive(Clone, Debug, PartialEq)]
pub enum ComponentSource {
    /// A component of a channel, from 0 on.
    Channel(Channel, usize),
    /// An output of the graph by its name; [`Preset::for_outputs`] replaces it.
    Output(String, OutputPart),
    /// A single value everywhere, 0..1.
    Constant(f32),
}

/// Part of an output that a component takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputPart {
    /// The component with this letter, from 0 on.
    Single(usize),
    /// One of the components that the whole output is written to.
    Whole {
        /// Index of it.
        at: usize,
        /// Number of them.
        of: usize,
    },
}

/// Condition for writing a file.
#[derive(Clone, Debug, PartialEq)]
pub enum When {
    /// If any of its channels varies over the surface.
    Varies,
    /// In every set.
    Always,
    /// If the graph gives the channel, and any of the file's channels varies.
    Connected(Channel),
    /// If the channel varies and has values above 1, which whole numbers cannot hold.
    AboveOne(Channel),
    /// If any of its own channels varies and has values above 1.
    ItselfAboveOne,
}

/// Encoding of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapFormat {
    /// PNG of whole numbers of 8 or 16 bits.
    Png {
        /// 8 or 16.
        bits: u8,
    },
    /// Truevision TGA of 8 bits.
    Tga,
    /// OpenEXR of 16-bit floats.
    ExrHalf,
    /// OpenEXR of 32-bit floats, as they are.
    Exr,
}

/// Size of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapSize {
    /// Maps of the bake, divided by this.
    Divided(u32),
    /// Pixels across and down.
    Fixed([u32; 2]),
}

impl Preset {
    /// Reads a preset from its TOML text; docs/presets.md describes the file. `file` names it in errors.
    pub fn parse(file: &str, text: &str) -> Result<Preset, PresetError> {
        read::parse(file, text)
    }

    /// Channels of materials that no file of the preset has a part of.
    pub fn left_out(&self) -> Vec<Channel> {
        let all = Channel::ALL.into_iter();
        all.filter(|channel| self.maps_of(channel).next().is_none()).collect()
    }

    /// The files that a channel becomes a part of.
    pub fn maps_of<'a>(&'a self, channel: &'a Channel) -> impl Iterator<Item = &'a Map> {
        self.maps.iter().filter(move |map| map.has(channel))
    }
}

impl Map {
    /// Returns true if the channel is a part of the file.
    pub fn has(&self, channel: &Channel) -> bool {
        match &self.content {
            MapContent::Every(kind) => channel.output_kind() == Some(*kind),
            MapContent::Packed(components) => components
                .iter()
                .any(|component| matches!(&component.source, ComponentSource::Channel(held, _) if held == channel)),
        }
    }

    /// The channels that the file is packed of; none for [`MapContent::Every`].
    pub fn channels(&self) -> BTreeSet<&Channel> {
        let components = match &self.content {
            MapContent::Packed(components) => &components[..],
            MapContent::Every(_) => &[],
        };
        let channels = components.iter().filter_map(|component| match &component.source {
            ComponentSource::Channel(channel, _) => Some(channel),
            ComponentSource::Output(..) | ComponentSource::Constant(_) => None,
        });
        channels.collect()
    }

    /// Pixels across and down, where the maps of the bake have `size`.
    pub fn pixels(&self, size: u32) -> [u32; 2] {
        match self.size {
            MapSize::Divided(by) => [(size / by.max(1)).max(1); 2],
            MapSize::Fixed(pixels) => pixels,
        }
    }

    /// Name of the file of a set.
    pub fn file_name(&self, names: &NamePattern, parts: &NameParts<'_>) -> String {
        format!("{}.{}", names.name(parts), self.format.ending())
    }
}

/// All components of a channel.
pub(crate) fn components_of(channel: &Channel) -> Vec<Component> {
    let component = |index| Component {
        source: ComponentSource::Channel(channel.clone(), index),
        is_inverted: false,
    };
    (0..channel.components()).map(component).collect()
}

impl MapFormat {
    /// Ending of file names.
    pub fn ending(self) -> &'static str {
        match self {
            MapFormat::Png { .. } => "png",
            MapFormat::Tga => "tga",
            MapFormat::ExrHalf | MapFormat::Exr => "exr",
        }
    }

    /// Bits of a sample.
    pub fn bits(self) -> u8 {
        match self {
            MapFormat::Png { bits } => bits,
            MapFormat::Tga => 8,
            MapFormat::ExrHalf => 16,
            MapFormat::Exr => 32,
        }
    }

    /// True for whole numbers, which hold 0..1.
    pub fn is_whole(self) -> bool {
        matches!(self, MapFormat::Png { .. } | MapFormat::Tga)
    }
}
