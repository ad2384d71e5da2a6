//! The form of a path, as a stroke keeps it.

use serde::{Deserialize, Serialize};

/// Bend of a path at each of its knots: with the places of its stroke, the path.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub struct PathForm {
    /// A letter for each knot in order: `s` smooth, `c` a corner, `h` with handles, whose places follow its own.
    pub(crate) knots: String,
    /// True if the path leads from its last knot back to the first.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) closed: bool,
}
