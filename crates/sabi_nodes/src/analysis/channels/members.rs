//! Members of `Material` and the channels that they belong to.

use super::writes::{Writes, always};
use crate::kind::Channel;

/// Members of `Material` and their channels, by name.
const MEMBERS: [(&str, Channel); 15] = [
    ("base_color", Channel::Color),
    ("alpha", Channel::Color),
    ("roughness", Channel::Surface),
    ("metallic", Channel::Surface),
    ("occlusion", Channel::Surface),
    ("height", Channel::Height),
    ("slope", Channel::Slope),
    ("emission", Channel::Emission),
    ("coat", Channel::Coat),
    ("coat_roughness", Channel::Coat),
    ("anisotropy", Channel::Anisotropy),
    ("sheen", Channel::Sheen),
    ("sheen_roughness", Channel::Sheen),
    ("subsurface", Channel::Subsurface),
    ("transmission", Channel::Subsurface),
];

/// Channel of each member of `Material`, in order; `None` for members that belong to none.
pub(super) struct Members {
    channels: Vec<Option<Channel>>,
}

impl Members {
    /// Finds the channels of the members of the struct `Material`.
    pub(super) fn of(members: &[naga::StructMember]) -> Members {
        let channel = |member: &naga::StructMember| {
            let name = member.name.as_deref();
            let known = MEMBERS.iter().find(|(known, _)| Some(*known) == name);
            known.map(|(_, channel)| *channel)
        };
        Members {
            channels: members.iter().map(channel).collect(),
        }
    }

    /// Channels of the members, in order.
    pub(super) fn channels(&self) -> &[Option<Channel>] {
        &self.channels
    }

    /// Returns the writes of a material whose members are all set.
    pub(super) fn all_set(&self) -> Writes {
        vec![always(); self.channels.len()]
    }

    /// Returns the writes of a material of which no member is set.
    pub(super) fn none_set(&self) -> Writes {
        vec![None; self.channels.len()]
    }

    /// Returns the writes of a material of zeros, which differs from the plain material in some members.
    pub(super) fn zero(&self) -> Writes {
        let members = 0..self.channels.len();
        members
            .map(|member| {
                if self.is_zero_when_plain(member) {
                    None
                } else {
                    always()
                }
            })
            .collect()
    }

    /// Returns true if the plain material is zero in this member.
    pub(super) fn is_zero_when_plain(&self, member: usize) -> bool {
        let channel = self.channels.get(member).copied().flatten();
        channel.is_some_and(|channel| !matches!(channel, Channel::Color | Channel::Surface))
    }
}
