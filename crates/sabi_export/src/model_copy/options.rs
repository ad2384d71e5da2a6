//! Options of a copy.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of a model's copy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CopyOptions {
    /// True to keep the model's properties that the new maps do not replace.
    pub keeps_look: bool,
    /// True to store maps, images and buffers in the file itself.
    pub embeds: bool,
}
