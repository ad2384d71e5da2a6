//! Which files a texture set becomes: data, so that a preset is a list and no code.

mod raw;

pub use raw::raw;

use crate::Channel;

/// A way to spread channels over files.
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
    /// What it holds.
    pub holds: Holds,
    /// How it is encoded.
    pub format: Format,
    /// When it is written.
    pub when: When,
}

/// What a file holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Holds {
    /// One channel.
    Channel(Channel),
    /// Each mask of the graph's own has such a file.
    EveryMask,
}

/// When a file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Whenever its channel varies.
    Always,
    /// When values of it exceed 1, which a PNG file cannot hold.
    AboveOne,
}

/// How a file is encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// PNG of whole numbers.
    Png {
        /// 8 or 16.
        bits: u8,
        /// What the codes mean.
        codes: Codes,
        /// Whether gradients are dithered; areas of one value never are.
        dither: bool,
    },
    /// OpenEXR of 32-bit floats, as they are.
    Exr,
}

/// What the codes of a PNG file mean.
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
        let tile = udim.map(|number| format!(".{number}")).unwrap_or_default();
        format!("{stem}{tile}.{ending}")
    }
}
