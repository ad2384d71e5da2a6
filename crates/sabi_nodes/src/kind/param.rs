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
    /// Values it takes, and how they are written.
    pub ty: ParamType,
    /// Byte offset in `struct Params`, from naga.
    pub offset: u32,
    /// [`ParamType::default`] as components.
    pub default: ParamValue,
    /// True if a loop's bound depends on it, so that the linked kernel clamps it to its range.
    pub bounds_a_loop: bool,
    /// True if it is one number that is read for each place and never for the whole surface at once, so that a mask can multiply
    /// it there.
    pub takes_mask: bool,
    /// `@absolute`: a length that is a share of the model where the lengths of a graph are shares of each piece.
    pub is_absolute: bool,
    /// Earlier names (`@was`).
    pub formerly: Vec<String>,
}
