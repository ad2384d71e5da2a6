//! Form of a path, as stored in a stroke.

use serde::{Deserialize, Serialize};

/// Bends of a path at its knots. Together with the points of its stroke, they are the path.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub struct PathForm {
    /// A letter for each knot in order: `s` for smooth, `c` for a corner, `h` for handles, whose points follow the point of the knot.
    pub(crate) knots: String,
    /// True if the path returns from its last knot to the first.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) closed: bool,
}
