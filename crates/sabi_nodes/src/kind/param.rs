//! Parameters of a kind: their names and places in memory.

use super::{ParamType, ParamValue};

/// One member of `struct Params`.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Name in WGSL and in graph files.
    pub name: String,
    /// Name shown to artists: `@label`, or the name with spaces and a capital.
    pub label: String,
    /// The doc comment without its annotations.
    pub doc: String,
    /// Values that the parameter takes, and how they are written.
    pub ty: ParamType,
    /// Byte offset in `struct Params`, from naga.
    pub offset: u32,
    /// [`ParamType::default`] as components.
    pub default: ParamValue,
    /// True if the bound of a loop depends on the parameter, so that the linked kernel clamps it to its range.
    pub bounds_a_loop: bool,
    /// True if the parameter is a single number that is only read for individual places, never for the whole surface at
    /// once, so that a mask can multiply it.
    pub takes_mask: bool,
    /// `@absolute`: the length is always a share of the model, even in a graph whose lengths are shares of each piece.
    pub is_absolute: bool,
    /// Earlier names (`@was`).
    pub formerly: Vec<String>,
}
