//! Conditions for setting the members of a material: toggles that must be on, and values that must not be zero.

use std::collections::BTreeSet;

use crate::kind::{Channel, ChannelWrite};

/// A parameter or input that must be on, or other than zero, for a channel to be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Need {
    /// A parameter, by index.
    Param(usize),
    /// An input, by index.
    Input(usize),
}

/// Condition for setting a member. `None`: it is never set. `Some(needs)`: it may be set if all of these are on.
pub(super) type Write = Option<BTreeSet<Need>>;

/// Returns the condition of a member that is always set.
pub(super) fn always() -> Write {
    Some(BTreeSet::new())
}

/// Returns the condition of a member that is set if one of two conditions holds.
pub(super) fn either(a: Write, b: Write) -> Write {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.intersection(&b).copied().collect()),
        (a, b) => a.or(b),
    }
}

/// Returns the minimal sets of needs, each once: a set that contains another one is left out.
pub(super) fn without_stronger(all: &[BTreeSet<Need>]) -> impl Iterator<Item = BTreeSet<Need>> {
    let weakest = move |(at, needs): (usize, &BTreeSet<Need>)| {
        let mut others = all.iter().enumerate().filter(|(other, _)| *other != at);
        let follows = others.any(|(other, weaker)| weaker.is_subset(needs) && (weaker != needs || other < at));
        (!follows).then(|| needs.clone())
    };
    all.iter().enumerate().filter_map(weakest)
}

/// Returns the condition of a member that is set only if both conditions hold, such as a product.
pub(super) fn both(a: Write, b: Write) -> Write {
    a.zip(b).map(|(a, b)| a.union(&b).copied().collect())
}

/// Conditions for the members of `Material` that a function sets.
pub(super) type Writes = Vec<Write>;

/// Adds the conditions of other writes, which additionally need some toggles.
pub(super) fn join(writes: &mut Writes, others: Writes, toggles: &BTreeSet<Need>) {
    for (write, other) in writes.iter_mut().zip(others) {
        *write = either(write.take(), other.map(|other| &other | toggles));
    }
}

/// Returns the [`ChannelWrite`] of a channel with its conditions.
pub(super) fn channel_write(channel: Channel, needs: BTreeSet<Need>) -> ChannelWrite {
    let param = |need: &Need| match need {
        Need::Param(index) => Some(*index),
        Need::Input(_) => None,
    };
    let input = |need: &Need| match need {
        Need::Input(index) => Some(*index),
        Need::Param(_) => None,
    };
    ChannelWrite {
        channel,
        unless_off: needs.iter().filter_map(param).collect(),
        unless_open: needs.iter().filter_map(input).collect(),
    }
}
