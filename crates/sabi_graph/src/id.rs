//! Names of nodes and of what they give.

use std::borrow::Borrow;
use std::fmt;
use std::str::FromStr;

use crate::problem::{Problem, shown};

/// Longest node id and port name, in characters.
const NAME_LIMIT: usize = 64;

/// A node's stable id: 1 to 64 of `a-z 0-9 _`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(String);

impl NodeId {
    /// The id as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl FromStr for NodeId {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        let fits = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
        if text.is_empty() || text.len() > NAME_LIMIT || !text.bytes().all(fits) {
            return Err(Problem::BadId { id: shown(text) });
        }
        Ok(NodeId(text.to_owned()))
    }
}

impl fmt::Display for NodeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Borrow<str> for NodeId {
    fn borrow(&self) -> &str {
        &self.0
    }
}

/// Checks the name of an input or output port: 1 to 64 characters, none of them a dot, a slash or a control character.
pub(crate) fn check_port_name(name: &str) -> Result<(), Problem> {
    let bad = |c: char| c == '.' || c == '/' || c.is_control();
    if name.is_empty() || name.chars().count() > NAME_LIMIT || name.contains(bad) {
        return Err(Problem::BadPortName { name: shown(name) });
    }
    Ok(())
}

/// One result of a node: `node`, its first output, or `node.port`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct OutputRef {
    /// The node that gives it.
    pub node: NodeId,
    /// The output port; `None` means the node's first.
    pub port: Option<String>,
}

impl FromStr for OutputRef {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        let (node, port) = match text.split_once('.') {
            None => (text, None),
            Some((node, port)) => {
                check_port_name(port)?;
                (node, Some(port.to_owned()))
            }
        };
        Ok(OutputRef {
            node: node.parse()?,
            port,
        })
    }
}

impl fmt::Display for OutputRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.port {
            None => write!(f, "{}", self.node),
            Some(port) => write!(f, "{}.{port}", self.node),
        }
    }
}

/// A parameter or an input of a node, written `node.name`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SlotRef {
    /// The node.
    pub node: NodeId,
    /// The parameter's or input's name.
    pub name: String,
}

impl FromStr for SlotRef {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        match text.split_once('.') {
            Some((node, name)) if !name.is_empty() => Ok(SlotRef {
                node: node.parse()?,
                name: name.to_owned(),
            }),
            _ => Err(Problem::BadSlot { text: shown(text) }),
        }
    }
}

impl fmt::Display for SlotRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.node, self.name)
    }
}
