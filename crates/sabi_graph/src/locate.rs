//! Finds the place of a node in the text of a graph file, for errors found after reading.

use crate::json::{Json, Member, Tree, parse};
use crate::text_position::line_and_column;

/// Returns line and column (both from 1, the column in characters) of a node in the text of a graph file, or of one of its
/// inputs or parameters. `node` is the id in a flat graph. For a node in a group (`instance/inner`), this is the place in
/// the group; if the group is a file of its own, it is the place of the instance.
pub fn locate(text: &str, node: &str, member: Option<&str>) -> Option<(usize, usize)> {
    let root = parse(text).ok()?;
    let mut body = &root;
    let mut found: Option<&Member> = None;
    for id in node.split('/') {
        let Some(here) = child(body, "nodes").and_then(|nodes| child(&nodes.value, id)) else {
            break;
        };
        found = Some(here);
        let name = child(&here.value, "group").map(|group| &group.value.tree);
        let Some(Tree::Text(name)) = name else { break };
        let Some(group) = child(&root, "groups").and_then(|groups| child(&groups.value, name)) else {
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
    Some(line_and_column(text, written.unwrap_or(here).key_at))
}

fn child<'a>(json: &'a Json, key: &str) -> Option<&'a Member> {
    match &json.tree {
        Tree::Object(members) => members.iter().find(|member| member.key == key),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::locate;

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
