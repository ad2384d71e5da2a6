//! Finds the place of a node in the text of a graph file, for errors found after reading.

use crate::json::{Json, Member, Tree, parse};
use crate::text_position::line_and_column;

/// Search for the places of nodes in the text of a graph file, which is parsed once for all of them.
#[derive(Debug)]
pub struct Locator<'t> {
    text: &'t str,
    /// None where the text is no JSON.
    root: Option<Json>,
}

impl<'t> Locator<'t> {
    /// Parses a text.
    pub fn new(text: &'t str) -> Locator<'t> {
        Locator {
            text,
            root: parse(text).ok(),
        }
    }

    /// Line and column (both from 1, the column in characters) of a node, or of one of its inputs or parameters. `node` is its id
    /// in a flat graph: of a node in a group (`instance/inner`) the place is that in the group, or that of the instance where the group
    /// is a file of its own.
    pub fn locate(&self, node: &str, member: Option<&str>) -> Option<(usize, usize)> {
        let found = found(self.root.as_ref()?, node, member)?;
        Some(line_and_column(self.text, found.key_at))
    }
}

/// Finds the member of the file that holds a node, or a member of it.
fn found<'j>(root: &'j Json, node: &str, member: Option<&str>) -> Option<&'j Member> {
    let mut body = root;
    let mut found: Option<&Member> = None;
    for id in node.split('/') {
        let Some(here) = child(body, "nodes").and_then(|nodes| child(&nodes.value, id)) else {
            break;
        };
        found = Some(here);
        let name = child(&here.value, "group").map(|group| &group.value.tree);
        let Some(Tree::Text(name)) = name else { break };
        let Some(group) = child(root, "groups").and_then(|groups| child(&groups.value, name)) else {
            break;
        };
        body = &group.value;
    }
    let here = found?;
    let written = member.and_then(|member| {
        let sections = ["inputs", "params"].into_iter();
        sections
            .filter_map(|section| child(&child(&here.value, section)?.value, member))
            .next()
    });
    Some(written.unwrap_or(here))
}

fn child<'a>(json: &'a Json, key: &str) -> Option<&'a Member> {
    match &json.tree {
        Tree::Object(members) => members.iter().find(|member| member.key == key),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::Locator;

    fn locate(text: &str, node: &str, member: Option<&str>) -> Option<(usize, usize)> {
        Locator::new(text).locate(node, member)
    }

    const TEXT: &str = r#"{
  "format": "sabi",
  "groups": {
    "g": { "nodes": {
        "inner": { "kind": "x", "inputs": { "source": "other" } } } }
  },
  "nodes": {
    "a": { "kind": "x", "params": { "size": 3 },
      "inputs": { "mask": "b" } },
    "look": { "kind": "graph/group", "group": "g" },
    "far": { "kind": "graph/group", "group": "other.sabi" }
  }
}"#;

    #[test]
    fn a_node_and_its_inputs_and_parameters_are_found() {
        let cases = [
            ("a", None, Some((8, 5))),
            ("a", Some("size"), Some((8, 37))),
            ("a", Some("mask"), Some((9, 19))),
            ("a", Some("not_written"), Some((8, 5))),
            ("look", None, Some((10, 5))),
            ("look/inner", Some("source"), Some((5, 45))),
            ("far/inner", None, Some((11, 5))),
            ("nobody", None, None),
        ];
        for (node, member, place) in cases {
            assert_eq!(locate(TEXT, node, member), place, "{node} {member:?}");
        }
        assert_eq!(locate("no graph", "a", None), None);
    }
}
