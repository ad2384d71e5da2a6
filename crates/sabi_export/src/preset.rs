//! Presets: the files of a texture set as data.

mod raw;

pub use raw::raw;

use crate::Channel;

/// Assignment of channels to files.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// Name on the command line.
    pub name: String,
    /// Its files, in the order of writing.
    pub maps: Vec<Map>,
}

/// One file of a preset.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Content of the file.
    pub holds: Holds,
    /// Encoding of the file.
    pub format: Format,
    /// Condition for writing it.
    pub when: When,
}

/// Content of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Holds {
    /// One channel.
    Channel(Channel),
    /// Each mask output of the graph, one file for each.
    EveryMask,
}

/// Condition for writing a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Whenever its channel varies.
    Always,
    /// If its channel varies and has values above 1, which a PNG file cannot hold.
    AboveOne,
}

/// Encoding of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// PNG of whole numbers.
    Png {
        /// 8 or 16.
        bits: u8,
        /// Meaning of the codes.
        codes: Codes,
        /// True if gradients are dithered; areas of one value never are.
        dither: bool,
    },
    /// OpenEXR of 32-bit floats, as they are.
    Exr,
}

/// Meaning of the codes of a PNG file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codes {
    /// Colors through the sRGB curve; the file says so.
    Srgb,
    /// 0..1.
    Unit,
    /// −1..1, unit vectors: 0 is the middle code rounded up.
    Signed,
    /// From the lowest to the highest value of the set; the report has them.
    Range,
}

impl Preset {
    /// The files that a channel becomes.
    pub fn maps_of<'a>(&'a self, channel: &'a Channel) -> impl Iterator<Item = &'a Map> {
        self.maps.iter().filter(move |map| match (&map.holds, channel) {
            (Holds::EveryMask, Channel::Mask(_)) => true,
            (Holds::Channel(held), channel) => held == channel,
            _ => false,
        })
    }
}

impl Map {
    /// Name of the file of a stem for a tile: `wood_base_color.png`, `wood_base_color.1002.png`.
    pub fn file_name(&self, stem: &str, udim: Option<u32>) -> String {
        let ending = match self.format {
            Format::Png { .. } => "png",
            Format::Exr => "exr",
        };
        let tile = udim.map_or_else(String::new, |number| format!(".{number}"));
        format!("{stem}{tile}.{ending}")
    }
}
