//! Channels of a texture set that are kept until all channels of their files have arrived.

use std::collections::{BTreeMap, BTreeSet};

use crate::preset::{Component, ComponentSource, Map, MapContent, MapSize, Preset, When};
use crate::{Channel, ChannelPixels, ConstantValue};

/// A channel that has arrived.
#[derive(Debug)]
pub(crate) struct HeldChannel {
    /// Pixels, padded; empty once no file needs them.
    pub(crate) pixels: ChannelPixels,
    pub(crate) constant: Option<ConstantValue>,
    /// Bounds of each component over the owned pixels.
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
    /// Highest value of all components; taken over all tiles of the material if its tiles share a scale.
    pub(crate) peak: f32,
    /// True if the graph provides the channel; false if it has the neutral value.
    pub(crate) is_connected: bool,
}

impl HeldChannel {
    /// Returns true if the channel has values that integers cannot represent.
    pub(crate) fn is_above_one(&self) -> bool {
        self.high.iter().any(|value| *value > 1.0)
    }
}

/// Number of a preset among those of a bake, and of a map in it.
pub(crate) type MapIndex = [usize; 2];

/// Channels of one texture set so far.
#[derive(Debug, Default)]
pub(crate) struct HeldSet {
    /// Channels that have arrived; `None` for a channel that the material does not have.
    channels: BTreeMap<Channel, Option<HeldChannel>>,
    /// Maps for which it is decided whether they are written.
    done: BTreeSet<MapIndex>,
}

impl HeldSet {
    /// Adds a channel, or the fact that the material does not have it. Returns the packed maps whose channels are now complete.
    pub(crate) fn add(&mut self, channel: &Channel, held: Option<HeldChannel>, presets: &[&Preset]) -> Vec<MapIndex> {
        self.channels.insert(channel.clone(), held);
        let is_complete =
            |map: &Map| map.has(channel) && map.channels().iter().all(|needed| self.channels.contains_key(needed));
        let found = packed(presets).filter(|(index, map)| !self.done.contains(index) && is_complete(map));
        found.map(|(index, _)| index).collect()
    }

    /// Returns the packed maps that still wait for channels that have not arrived.
    pub(crate) fn waiting(&self, presets: &[&Preset]) -> Vec<MapIndex> {
        let waits = packed(presets).filter(|(index, _)| !self.done.contains(index));
        waits.map(|(index, _)| index).collect()
    }

    /// Marks a map as decided, and drops the channels that no other map needs.
    pub(crate) fn finish(&mut self, index: MapIndex, presets: &[&Preset]) {
        self.done.insert(index);
        let needed: BTreeSet<&Channel> = packed(presets)
            .filter(|(index, _)| !self.done.contains(index))
            .flat_map(|(_, map)| map.channels())
            .collect();
        for (channel, held) in &mut self.channels {
            if let Some(held) = held.as_mut().filter(|_| !needed.contains(channel)) {
                held.pixels.data = Vec::new();
            }
        }
    }

    /// The channel, if the material has it.
    pub(crate) fn channel(&self, channel: &Channel) -> Option<&HeldChannel> {
        self.channels.get(channel)?.as_ref()
    }

    /// Returns the value of a component that is the same everywhere.
    pub(crate) fn constant(&self, component: &Component) -> Option<f32> {
        let value = match &component.source {
            ComponentSource::Constant(value) => *value,
            // Outputs do not occur here any more, since the preset was adapted to the graph.
            ComponentSource::Output(..) => 0.0,
            ComponentSource::Channel(channel, index) => match self.channel(channel) {
                // Without the channel, its neutral value is used.
                None => channel.neutral().get(*index).copied()?,
                Some(held) => held.constant?.component(*index),
            },
        };
        Some(if component.is_inverted { 1.0 - value } else { value })
    }

    /// Returns the divisor of the values of a map: 1, except for normalized emission above 1.
    pub(crate) fn scale(&self, map: &Map) -> f32 {
        if !map.is_normalized {
            return 1.0;
        }
        // A normalized height spans its range and needs no divisor.
        let emission = map
            .channels()
            .into_iter()
            .find(|channel| **channel == Channel::Emission);
        let held = emission.and_then(|channel| self.channel(channel));
        held.map_or(1.0, |held| held.peak.max(1.0))
    }

    /// Returns true if a map is to be written.
    pub(crate) fn is_wanted(&self, map: &Map, all_maps: bool) -> bool {
        let MapContent::Packed(components) = &map.content else {
            return true;
        };
        let exists = map.channels().iter().any(|channel| self.channel(channel).is_some());
        let varies = components.iter().any(|component| self.constant(component).is_none());
        match &map.when {
            When::Always => true,
            When::Varies => exists && (varies || all_maps),
            When::Connected(channel) => {
                (varies || all_maps) && self.channel(channel).is_some_and(|held| held.is_connected)
            }
            When::AboveOne(channel) => {
                (varies || all_maps) && self.channel(channel).is_some_and(HeldChannel::is_above_one)
            }
            When::ItselfAboveOne => {
                let channels = map.channels();
                let mut held = channels.iter().filter_map(|channel| self.channel(channel));
                (varies || all_maps) && held.any(HeldChannel::is_above_one)
            }
        }
    }
}

/// The packed maps of all presets.
fn packed<'p>(presets: &[&'p Preset]) -> impl Iterator<Item = (MapIndex, &'p Map)> {
    let of_preset = |(preset, maps): (usize, &&'p Preset)| {
        let maps = maps.maps.iter().enumerate();
        maps.map(move |(map, of)| ([preset, map], of)).collect::<Vec<_>>()
    };
    let all: Vec<(MapIndex, &Map)> = presets.iter().enumerate().flat_map(of_preset).collect();
    all.into_iter()
        .filter(|(_, map)| matches!(map.content, MapContent::Packed(_)))
}

/// Returns true if a map has the size of the bake.
pub(crate) fn is_whole_size(map: &Map) -> bool {
    map.size == MapSize::Divided(1)
}
