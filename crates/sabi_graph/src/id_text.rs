//! Reading the names of nodes, ports and parameters.

use std::str::FromStr;

use crate::id::{NodeId, OutputRef, SlotRef};
use crate::problem::{Problem, quoted};

/// Longest node id and port name, in characters.
const NAME_LIMIT: usize = 64;

/// Checks the name of an input or output port: 1 to 64 characters, without dots, slashes and control characters.
pub(crate) fn check_port_name(name: &str) -> Result<(), Problem> {
    let bad = |c: char| c == '.' || c == '/' || c.is_control();
    if name.is_empty() || name.chars().count() > NAME_LIMIT || name.contains(bad) {
        return Err(Problem::BadPortName { name: quoted(name) });
    }
    Ok(())
}

impl FromStr for NodeId {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        let fits = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
        if text.is_empty() || text.len() > NAME_LIMIT || !text.bytes().all(fits) {
            return Err(Problem::BadId { id: quoted(text) });
        }
        Ok(NodeId(text.to_owned()))
    }
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

impl FromStr for SlotRef {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        match text.split_once('.') {
            Some((node, name)) if !name.is_empty() => Ok(SlotRef {
                node: node.parse()?,
                name: name.to_owned(),
            }),
            _ => Err(Problem::BadSlot { text: quoted(text) }),
        }
    }
}
