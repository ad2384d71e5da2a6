//! Rules that a graph can break, in files and by edits.

use crate::id::NodeId;

/// A broken rule of a graph.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Problem {
    /// A node id with characters or a length that are not allowed.
    #[error("{id} cannot be a node's id; use 1 to 64 of the characters a-z, 0-9 and _")]
    BadId {
        /// The id, quoted.
        id: String,
    },
    /// A port name that cannot be written in a link.
    #[error("{name} cannot be the name of a port; use 1 to 64 characters without dots and slashes")]
    BadPortName {
        /// The name, quoted.
        name: String,
    },
    /// A text that is not `node.name`.
    #[error("{text} names no parameter or input; write the node's id, a dot and the name, as in \"edges.width\"")]
    BadSlot {
        /// The text, quoted.
        text: String,
    },
    /// A name of a knob, variant, frame or group with characters or a length that are not allowed.
    #[error("{name} cannot be the name of a {what}; use 1 to 200 characters, {without}")]
    BadName {
        /// `knob`, `variant`, `frame` or `group`.
        what: &'static str,
        /// The name, quoted.
        name: String,
        /// The characters that are not allowed.
        without: &'static str,
    },
    /// A node without a kind.
    #[error("the node has no kind; give it one, as in \"kind\": \"noise/simplex\"")]
    NoKind,
    /// Two nodes with one id.
    #[error("there is a node \"{id}\" already; choose another id")]
    NodeExists {
        /// The id.
        id: NodeId,
    },
    /// A reference to a node that does not exist.
    #[error("there is no node {name}{hint}")]
    NoSuchNode {
        /// The name, quoted.
        name: String,
        /// The nearest id, as a question.
        hint: String,
    },
    /// A node that reads itself.
    #[error("node \"{id}\" cannot read its own result; connect another node")]
    SelfLink {
        /// The node.
        id: NodeId,
    },
    /// Links that lead in a circle.
    #[error("the nodes feed each other in a circle: {}; remove one of these links", arrows(.nodes))]
    Cycle {
        /// Nodes of the circle in the order of the links, each once.
        nodes: Vec<NodeId>,
    },
    /// An instance of a group that does not exist.
    #[error("there is no group {name}{hint}; define it under \"groups\", or name a .sabi file")]
    NoSuchGroup {
        /// The name, quoted.
        name: String,
        /// The nearest group, as a question.
        hint: String,
    },
    /// A node of kind `graph/group` without the name of a group.
    #[error("the node is a group instance but names no group; add \"group\": \"name or file.sabi\"")]
    GroupNotNamed,
    /// A variant that sets a knob that is not exposed.
    #[error("variant {variant} sets {knob}, which is not exposed{hint}")]
    NotExposed {
        /// The variant, quoted.
        variant: String,
        /// The name it sets, quoted.
        knob: String,
        /// The nearest knob, as a question.
        hint: String,
    },
    /// A range with its ends in the wrong order.
    #[error("the range of knob {knob} is empty; write the lower end first")]
    EmptyRange {
        /// The knob, quoted.
        knob: String,
    },
    /// A curve with too few or unusable points.
    #[error(
        "the curve of {slot} cannot be used; write at least two points [knob value, parameter value] whose knob values grow"
    )]
    BadCurve {
        /// `node.param`.
        slot: String,
    },
    /// A curve of a parameter that the knob does not set.
    #[error("knob {knob} has a curve for {slot}, which it does not set; add it to \"to\", or take the curve out")]
    StrayCurve {
        /// The knob, quoted.
        knob: String,
        /// `node.param`.
        slot: String,
    },
    /// A knob with curves and without a default.
    #[error("knob {knob} has curves and no default; write the number that it stands at as \"default\"")]
    CurveWithoutDefault {
        /// The knob, quoted.
        knob: String,
    },
    /// Two inputs of a group that feed the same input of a node.
    #[error("group inputs \"{first}\" and \"{second}\" both feed {slot}; let only one of them do so")]
    FedTwice {
        /// One group input.
        first: String,
        /// The other.
        second: String,
        /// `node.input`.
        slot: String,
    },
    /// A number that a file cannot hold, or a value nested too deep.
    #[error(
        "the value of {name} cannot be kept: numbers must be finite and below 3.4e38, lists nested at most 64 levels"
    )]
    BadValue {
        /// Parameter or knob of the value, quoted.
        name: String,
    },
}

/// Formats a circle as `a → b → a`, with at most sixteen nodes.
fn arrows(nodes: &[NodeId]) -> String {
    let mut text = String::new();
    for id in nodes.iter().take(16) {
        text.push_str(id.as_str());
        text.push_str(" → ");
    }
    if nodes.len() > 16 {
        text.push_str("… → ");
    }
    text.push_str(nodes.first().map_or("", NodeId::as_str));
    text
}

/// A text in quotes for a message, shortened, with control characters escaped.
pub(crate) fn quoted(text: &str) -> String {
    const LONGEST: usize = 80;
    let mut cut: String = text.chars().take(LONGEST).collect();
    if cut.len() < text.len() {
        cut.push('…');
    }
    format!("{cut:?}")
}

/// Returns ` (did you mean "x"?)`, or an empty text.
pub(crate) fn hint<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    match crate::nearest(word, candidates) {
        Some(near) => format!(" (did you mean {}?)", quoted(near)),
        None => String::new(),
    }
}

/// Lists names in quotes with commas, at most twelve.
pub(crate) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    const MOST: usize = 12;
    let mut names_in_quotes: Vec<String> = Vec::new();
    let mut more = 0_usize;
    for name in names {
        if names_in_quotes.len() < MOST {
            names_in_quotes.push(quoted(name));
        } else {
            more += 1;
        }
    }
    match (names_in_quotes.is_empty(), more) {
        (true, _) => "none".to_owned(),
        (false, 0) => names_in_quotes.join(", "),
        (false, _) => format!("{} and {more} more", names_in_quotes.join(", ")),
    }
}
