//! Facts about the files of a set, recorded while they are written.

use std::collections::BTreeMap;

use crate::held_channels::MapIndex;
use crate::preset::Component;
use crate::{Channel, ConstantValue};

/// Channels and files of one texture set.
#[derive(Clone, Debug, Default)]
pub(crate) struct SetFacts {
    /// Stem of the set's files: the material.
    pub(crate) name: String,
    /// Pixels along a side of the maps.
    pub(crate) size: u32,
    /// Channels of the material, without masks.
    pub(crate) channels: BTreeMap<Channel, ChannelFacts>,
    /// Files that were written.
    pub(crate) files: BTreeMap<MapIndex, FileFacts>,
}

/// A file of one set.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FileFacts {
    /// Plain file name.
    pub(crate) name: String,
    /// Components that it has.
    pub(crate) components: Vec<Component>,
    /// Divisor of its values.
    pub(crate) scale: f32,
}

/// Values of a channel in one set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChannelFacts {
    /// The value, if it is the same everywhere.
    pub(crate) constant: Option<ConstantValue>,
    /// Lowest and highest value of its first component.
    pub(crate) range: [f32; 2],
}

impl SetFacts {
    /// Adds a channel. Outputs of the graph and maps of the model are ignored, since they do not belong to a material.
    pub(crate) fn add(&mut self, channel: &Channel, facts: ChannelFacts) {
        if channel.output_kind().is_none() && !matches!(channel, Channel::Mesh(_)) {
            self.channels.insert(channel.clone(), facts);
        }
    }

    /// Returns the value of a channel that is the same everywhere; the neutral value if the material does not have the channel.
    pub(crate) fn constant(&self, channel: &Channel) -> Option<ConstantValue> {
        match self.channels.get(channel) {
            Some(facts) => facts.constant,
            None => Some(ConstantValue::neutral(channel)),
        }
    }
}
