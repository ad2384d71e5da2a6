//! Types of ports.

use std::fmt;

/// The type of a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PortType {
    /// One number for each surface point.
    Mask,
    /// Linear RGB.
    Color,
    /// Three numbers: a point or a direction.
    Vector,
    /// A physically based material.
    Material,
}

impl PortType {
    /// All port types.
    pub const ALL: [PortType; 4] = [PortType::Mask, PortType::Color, PortType::Vector, PortType::Material];

    /// Returns true if an input of this type can be linked to a result of type `from`: the types are equal, or they are
    /// mask and color, which are converted into each other (gray; luminance).
    pub fn accepts(self, from: PortType) -> bool {
        use PortType::{Color, Mask};
        self == from || matches!((self, from), (Mask, Color) | (Color, Mask))
    }
}

impl fmt::Display for PortType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            PortType::Mask => "mask",
            PortType::Color => "color",
            PortType::Vector => "vector",
            PortType::Material => "material",
        })
    }
}
