//! Migration of older files: each step is a pure function from the JSON of one version to the JSON of the next. Offsets are
//! kept, so that an error in an old file points into its text.

use std::collections::BTreeMap;

use crate::file_error::{FileProblem, ReadError};
use crate::json::{Json, Member, Tree};
use crate::problem::{Problem, hint, quoted};

/// Migration steps. Step `n` leads from version `n` to `n + 1`.
const STEPS: [fn(Json) -> Result<Json, ReadError>; 1] = [links_into_nodes];

/// The version that is written, which is also the newest that can be read.
pub(crate) const NEWEST: u32 = STEPS.len() as u32;

/// Migrates a file to the newest version.
pub(crate) fn to_newest(mut json: Json) -> Result<Json, ReadError> {
    let version = version_of(&json)?;
    for step in STEPS.iter().skip(version as usize) {
        json = step(json)?;
    }
    Ok(json)
}

/// Version of a file in the graph format.
pub(crate) fn version_of(json: &Json) -> Result<u32, ReadError> {
    let not_sabi = |at| ReadError::new(at, FileProblem::NotSabi);
    let Tree::Object(members) = &json.tree else {
        return Err(not_sabi(json.at));
    };
    let value = |key: &str| {
        members
            .iter()
            .find(|member| member.key == key)
            .map(|member| &member.value)
    };
    match value("format") {
        Some(Json {
            tree: Tree::Text(format),
            ..
        }) if format == "sabi" => {}
        Some(other) => return Err(not_sabi(other.at)),
        None => return Err(not_sabi(json.at)),
    }
    let Some(version) = value("version") else {
        let advice = "write \"version\": 1 after the format";
        return Err(ReadError::new(
            json.at,
            FileProblem::Missing {
                key: quoted("version"),
                advice,
            },
        ));
    };
    match version.tree {
        Tree::Number(x) if x > f64::from(NEWEST) => Err(ReadError::new(
            version.at,
            FileProblem::Newer {
                version: crate::value::number_text(x),
                newest: NEWEST,
            },
        )),
        Tree::Number(x) if x >= 0.0 && x.fract() == 0.0 => Ok(x as u32),
        _ => Err(ReadError::expected(
            version,
            "version",
            format!("a whole number from 0 to {NEWEST}"),
        )),
    }
}

/// Migrates version 0 to 1. Version 0, before the first release, kept links in a list beside the nodes, `"edges": [{"from": "node.port",
/// "to": "node.input"}]`, which led to a conflict in every merge of two branches. Version 1 keeps each link in the node that reads it.
fn links_into_nodes(mut json: Json) -> Result<Json, ReadError> {
    if let Some(groups) = members_of(&mut json, "groups") {
        for group in groups {
            move_links(&mut group.value).map_err(|error| error.in_group(&group.key))?;
        }
    }
    move_links(&mut json)?;
    set_version(&mut json, 1);
    Ok(json)
}

fn move_links(body: &mut Json) -> Result<(), ReadError> {
    let Tree::Object(members) = &mut body.tree else {
        return Ok(());
    };
    let Some(place) = members.iter().position(|member| member.key == "edges") else {
        return Ok(());
    };
    let edges = members.remove(place).value;
    let Tree::List(edges) = edges.tree else {
        return Err(ReadError::expected(&edges, "edges", "a list of links"));
    };
    let mut no_nodes = Vec::new();
    let nodes = members_of(body, "nodes").unwrap_or(&mut no_nodes);
    let index: BTreeMap<String, usize> = nodes.iter().map(|node| node.key.clone()).zip(0..).collect();
    for edge in edges {
        let (from, to) = ends(edge)?;
        let Tree::Text(slot) = &to.tree else {
            return Err(ReadError::expected(&to, "to", "a text \"node.input\""));
        };
        let Some((id, input)) = slot.split_once('.') else {
            return Err(ReadError::new(to.at, Problem::BadSlot { text: quoted(slot) }));
        };
        let Some(&reader) = index.get(id) else {
            let hint = hint(id, index.keys().map(String::as_str));
            return Err(ReadError::new(to.at, Problem::NoSuchNode { name: quoted(id), hint }));
        };
        let in_input = |error: ReadError| error.in_node(id).in_port(input);
        add_input(&mut nodes[reader].value, input, from, to.at).map_err(in_input)?;
    }
    Ok(())
}

/// Returns `from` and `to` of an edge.
fn ends(edge: Json) -> Result<(Json, Json), ReadError> {
    let example = "a link like {\"from\": \"node.port\", \"to\": \"node.input\"}";
    let Json {
        at,
        tree: Tree::Object(members),
    } = edge
    else {
        return Err(ReadError::expected(
            &edge,
            "edges",
            format!("a list with {example} in each place"),
        ));
    };
    let (mut from, mut to) = (None, None);
    for member in members {
        match member.key.as_str() {
            "from" => from = Some(member.value),
            "to" => to = Some(member.value),
            _ => {}
        }
    }
    let advice = "a link says both where it comes from and where it leads to";
    match (from, to) {
        (Some(from), Some(to)) => Ok((from, to)),
        (None, _) => Err(ReadError::new(
            at,
            FileProblem::Missing {
                key: quoted("from"),
                advice,
            },
        )),
        (_, None) => Err(ReadError::new(
            at,
            FileProblem::Missing {
                key: quoted("to"),
                advice,
            },
        )),
    }
}

fn add_input(node: &mut Json, input: &str, from: Json, at: usize) -> Result<(), ReadError> {
    let Tree::Object(members) = &mut node.tree else {
        return Err(ReadError::expected(
            node,
            "nodes",
            "an object with a \"kind\" in each place",
        ));
    };
    let place = members
        .iter()
        .position(|member| member.key == "inputs")
        .unwrap_or_else(|| {
            let value = Json {
                at,
                tree: Tree::Object(Vec::new()),
            };
            members.push(Member {
                key: "inputs".to_owned(),
                key_at: at,
                value,
            });
            members.len() - 1
        });
    let inputs = &mut members[place].value;
    let Tree::Object(links) = &mut inputs.tree else {
        return Err(ReadError::expected(
            inputs,
            "inputs",
            "an object with a link for each input",
        ));
    };
    if links.iter().any(|link| link.key == input) {
        let key = quoted("edges");
        let expected = "a list with one link for each input".to_owned();
        let found = "two links into the same one".to_owned();
        return Err(ReadError::new(at, FileProblem::Expected { key, expected, found }));
    }
    links.push(Member {
        key: input.to_owned(),
        key_at: at,
        value: from,
    });
    Ok(())
}

/// The members of the object under a key.
fn members_of<'a>(json: &'a mut Json, key: &str) -> Option<&'a mut Vec<Member>> {
    let Tree::Object(members) = &mut json.tree else {
        return None;
    };
    match &mut members.iter_mut().find(|member| member.key == key)?.value.tree {
        Tree::Object(members) => Some(members),
        _ => None,
    }
}

fn set_version(json: &mut Json, version: u32) {
    if let Tree::Object(members) = &mut json.tree {
        for member in members.iter_mut().filter(|member| member.key == "version") {
            member.value.tree = Tree::Number(f64::from(version));
        }
    }
}
