//! What the names of parts and of nodes above them mean to engines.

use std::collections::{BTreeMap, BTreeSet};

use super::node_groups::{NamedPart, NodeGroups};
use crate::model::ExclusionReason;

/// What leaves a part out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NameMeaning {
    pub(super) left_out: ExclusionReason,
    /// Name of the node above the part that says so; none where its own name does.
    pub(super) of_group: Option<String>,
}

/// Returns for each part the reason why its name, or the name of a node above it, leaves it out. If that would leave
/// out all parts, none is left out.
pub(super) fn by_names(parts: &[NamedPart], groups: &NodeGroups) -> Vec<Option<NameMeaning>> {
    let names: Vec<Name> = parts.iter().map(|part| Name::new(part.name, part.group)).collect();
    let group_names: Vec<Name> = groups
        .all()
        .iter()
        .map(|group| Name::new(&group.name, group.above))
        .collect();
    let own = own_meanings(&names);
    let of_groups = group_meanings(&group_names, &names);
    let of_groups = groups.inherited(|number, group| {
        let left_out = of_groups[number]?;
        Some(NameMeaning {
            left_out,
            of_group: Some(group.name.clone()),
        })
    });
    let meaning = |(part, own): (&NamedPart, Option<ExclusionReason>)| {
        let own = own.map(|left_out| NameMeaning {
            left_out,
            of_group: None,
        });
        own.or_else(|| of_groups[part.group?].clone())
    };
    let found: Vec<Option<NameMeaning>> = parts.iter().zip(own).map(meaning).collect();
    if found.iter().all(Option::is_some) {
        return vec![None; parts.len()];
    }
    found
}

/// A name, taken apart.
struct Name {
    /// In lower case and without an appended number.
    plain: String,
    /// Node above it.
    above: Option<usize>,
    level: Option<DetailLevel>,
}

/// A level of detail that a name says.
#[derive(Clone, Debug, PartialEq, Eq)]
struct DetailLevel {
    /// The rest of the name in lower case.
    of: String,
    number: u32,
}

impl Name {
    fn new(name: &str, above: Option<usize>) -> Name {
        let plain = without_number(name).to_lowercase();
        Name {
            above,
            level: level(&plain),
            plain,
        }
    }
}

/// Returns what leaves parts out by their own names.
fn own_meanings(names: &[Name]) -> Vec<Option<ExclusionReason>> {
    let known: BTreeSet<&str> = names.iter().map(|name| name.plain.as_str()).collect();
    let is_hull: Vec<bool> = names.iter().map(|name| is_hull(&name.plain, &known)).collect();
    let mut finest: BTreeMap<&str, u32> = BTreeMap::new();
    let seen = names.iter().zip(&is_hull).filter(|(_, is_hull)| !**is_hull);
    for level in seen.filter_map(|(name, _)| name.level.as_ref()) {
        // A part of the bare name is finer than all levels.
        let number = if known.contains(level.of.as_str()) {
            0
        } else {
            level.number
        };
        let least = finest.entry(&level.of).or_insert(number);
        *least = number.min(*least);
    }
    let left_out = |(name, is_hull): (&Name, bool)| {
        let is_coarser = |level: &DetailLevel| {
            finest
                .get(level.of.as_str())
                .is_some_and(|finest| level.number > *finest)
        };
        match &name.level {
            _ if is_hull => Some(ExclusionReason::Hull),
            Some(level) if is_coarser(level) => Some(ExclusionReason::CoarserLevel),
            _ => None,
        }
    };
    names.iter().zip(is_hull).map(left_out).collect()
}

/// Returns what leaves out all below each node. Levels of detail count among the nodes and parts below the same node.
fn group_meanings(groups: &[Name], parts: &[Name]) -> Vec<Option<ExclusionReason>> {
    let known: BTreeSet<&str> = groups.iter().chain(parts).map(|name| name.plain.as_str()).collect();
    let beside: BTreeSet<(Option<usize>, &str)> = groups
        .iter()
        .chain(parts)
        .map(|name| (name.above, name.plain.as_str()))
        .collect();
    let mut finest: BTreeMap<(Option<usize>, &str), u32> = BTreeMap::new();
    for name in groups.iter().chain(parts) {
        let Some(level) = &name.level else { continue };
        let key = (name.above, level.of.as_str());
        let number = if beside.contains(&key) { 0 } else { level.number };
        let least = finest.entry(key).or_insert(number);
        *least = number.min(*least);
    }
    let left_out = |name: &Name| {
        if is_hull(&name.plain, &known) || is_group_of_hulls(&name.plain) {
            return Some(ExclusionReason::Hull);
        }
        let level = name.level.as_ref()?;
        let finest = finest.get(&(name.above, level.of.as_str()))?;
        (level.number > *finest).then_some(ExclusionReason::CoarserLevel)
    };
    groups.iter().map(left_out).collect()
}

/// Name without the number that programs append to a name that is taken: `.001`.
fn without_number(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((before, digits)) if digits.len() == 3 && digits.bytes().all(|digit| digit.is_ascii_digit()) => before,
        _ => name,
    }
}

/// Prefixes of collision hulls of Unreal, lower case.
const HULL_PREFIXES: [&str; 5] = ["ucx_", "ubx_", "usp_", "ucp_", "mcdcx_"];
/// Endings of what Godot and Unity use and do not draw, lower case.
const HULL_ENDINGS: [&str; 6] = ["colonly", "convcolonly", "occonly", "navmesh", "collider", "collision"];
/// Endings by which Godot derives a hull from a part that it draws, unless there is a part of the bare name.
const DRAWN_HULL_ENDINGS: [&str; 2] = ["col", "convcol"];
/// Letters before these endings.
const BEFORE_ENDING: [char; 5] = ['-', '_', '$', '.', ' '];
/// Names of nodes that hold hulls, lower case.
const HULL_GROUPS: [&str; 6] = ["collision", "collisions", "collider", "colliders", "colonly", "navmesh"];

/// Returns true if a part is a collision hull by its plain name; `known` are the plain names of those that it may belong to.
fn is_hull(name: &str, known: &BTreeSet<&str>) -> bool {
    if HULL_PREFIXES.iter().any(|prefix| name.starts_with(prefix)) {
        return true;
    }
    let Some((bare, ending)) = unnumbered(name).rsplit_once(BEFORE_ENDING) else {
        return false;
    };
    HULL_ENDINGS.contains(&ending) || DRAWN_HULL_ENDINGS.contains(&ending) && known.contains(bare)
}

/// Returns true if a node holds hulls by its plain name.
fn is_group_of_hulls(name: &str) -> bool {
    HULL_GROUPS.contains(&unnumbered(name))
}

/// Name without the digits at its end, past which Godot looks.
fn unnumbered(name: &str) -> &str {
    name.trim_end_matches(|letter: char| letter.is_ascii_digit())
}

/// Level of detail that a plain name says: `rock_lod1`, `rock_lod_1`; none for other names.
fn level(name: &str) -> Option<DetailLevel> {
    let is_apart = |letter: Option<char>| letter.is_none_or(|letter| BEFORE_ENDING.contains(&letter));
    let (at, number) = name.rmatch_indices("lod").find_map(|(at, word)| {
        let behind = at + word.len();
        let gap = usize::from(name[behind..].starts_with(['_', '-']));
        let digits = name[behind + gap..].bytes().take_while(u8::is_ascii_digit).count();
        let number = behind + gap..behind + gap + digits;
        let is_word = is_apart(name[..at].chars().next_back()) && is_apart(name[number.end..].chars().next());
        (digits > 0 && is_word).then_some((at, number))
    })?;
    let before = name[..at].strip_suffix(BEFORE_ENDING).unwrap_or(&name[..at]);
    Some(DetailLevel {
        of: format!("{before}{}", &name[number.end..]),
        number: name[number].parse().ok()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left_out_below<'n>(groups: &[(&str, Option<usize>)], parts: &[(&'n str, Option<usize>)]) -> Vec<&'n str> {
        let mut nodes = NodeGroups::default();
        for (name, above) in groups {
            nodes.add(name, *above, false);
        }
        let parts: Vec<NamedPart> = parts
            .iter()
            .map(|(name, group)| NamedPart { name, group: *group })
            .collect();
        let meanings = by_names(&parts, &nodes);
        let out = parts.iter().zip(meanings).filter(|(_, meaning)| meaning.is_some());
        out.map(|(part, _)| part.name).collect()
    }

    fn left_out<'n>(names: &[&'n str]) -> Vec<&'n str> {
        let parts: Vec<(&str, Option<usize>)> = names.iter().map(|name| (*name, None)).collect();
        left_out_below(&[], &parts)
    }

    #[test]
    fn the_finest_level_of_each_name_stays() {
        let cases: [(&[&str], &[&str]); 11] = [
            (&["Rock_LOD0", "Rock_LOD1", "Rock_LOD2"], &["Rock_LOD1", "Rock_LOD2"]),
            (&["Rock_LOD1", "Rock_LOD2", "Tree"], &["Rock_LOD2"]),
            (&["Rock", "Rock_LOD1", "rock_lod2"], &["Rock_LOD1", "rock_lod2"]),
            (&["Rock_LOD1", "Tree"], &[]),
            (&["a-lod0", "a-lod10", "b LOD1", "b.LOD2"], &["a-lod10", "b.LOD2"]),
            (&["LOD0", "LOD1"], &["LOD1"]),
            (
                &["Oak_LOD0_Leaves", "Oak_LOD1_Leaves", "Oak_LOD1_Trunk"],
                &["Oak_LOD1_Leaves"],
            ),
            (&["Rock_LOD0", "Rock_LOD1.001", "Rock_LOD0.001"], &["Rock_LOD1.001"]),
            (
                &["Rock_LOD_0", "Rock_lod_1", "Rock_LOD-02"],
                &["Rock_lod_1", "Rock_LOD-02"],
            ),
            (&["Explode1", "Explode2", "Melody_LODge1"], &[]),
            (&["x_LOD99999999999", "x_LOD1"], &[]),
        ];
        for (names, expected) in cases {
            assert_eq!(left_out(names), expected, "{names:?}");
        }
    }

    #[test]
    fn hulls_of_engines_are_no_parts_of_what_is_seen() {
        let cases: [(&[&str], &[&str]); 6] = [
            (
                &[
                    "Rock",
                    "UCX_Rock_00",
                    "ubx_Rock",
                    "USP_Rock",
                    "UCP_Rock.001",
                    "MCDCX_Rock",
                ],
                &["UCX_Rock_00", "ubx_Rock", "USP_Rock", "UCP_Rock.001", "MCDCX_Rock"],
            ),
            (
                &[
                    "Wall",
                    "Wall-colonly",
                    "Wall-convcolonly2",
                    "Floor_navmesh",
                    "Wall$occonly",
                ],
                &["Wall-colonly", "Wall-convcolonly2", "Floor_navmesh", "Wall$occonly"],
            ),
            (
                &["Door", "Door_collider", "Door.Collision"],
                &["Door_collider", "Door.Collision"],
            ),
            // Godot draws `Door-col`, and makes a hull of it besides.
            (&["Door-col", "Frame"], &[]),
            (&["Door-col", "Door"], &["Door-col"]),
            (&["ship_hull", "Protocol", "Collider", "UCXRock", "color"], &[]),
        ];
        for (names, expected) in cases {
            assert_eq!(left_out(names), expected, "{names:?}");
        }
        assert_eq!(
            left_out(&["UCX_a", "UCX_b"]),
            [""; 0],
            "hulls alone are what there is to see"
        );
    }

    #[test]
    fn names_of_nodes_above_parts_count() {
        // Levels of a group, each with parts of the same plain names.
        assert_eq!(
            left_out_below(
                &[
                    ("Truck", None),
                    ("LOD0", Some(0)),
                    ("LOD1", Some(0)),
                    ("Doors", Some(2))
                ],
                &[
                    ("body", Some(1)),
                    ("wheel", Some(1)),
                    ("body.001", Some(2)),
                    ("door", Some(3))
                ],
            ),
            ["body.001", "door"]
        );
        // Each group has levels of its own: a lone one stays.
        assert_eq!(
            left_out_below(
                &[("Truck", None), ("LOD0", Some(0)), ("Car", None), ("LOD1", Some(2))],
                &[("body", Some(1)), ("chassis", Some(3))],
            ),
            [""; 0]
        );
        for hulls in [
            "collision",
            "Colliders",
            "UCX_Truck",
            "Truck-colonly",
            "Truck_Collision",
            "navmesh.001",
        ] {
            assert_eq!(
                left_out_below(&[(hulls, None)], &[("body", None), ("box", Some(0))]),
                ["box"],
                "{hulls}"
            );
        }
        // A part of level 0 beside a node of level 1.
        assert_eq!(
            left_out_below(
                &[("Rock_LOD1", None)],
                &[("Rock_LOD0", None), ("stone", Some(0)), ("moss", Some(0))]
            ),
            ["stone", "moss"]
        );
        assert_eq!(
            left_out_below(&[("collision", None)], &[("box", Some(0))]),
            [""; 0],
            "hulls alone are what there is to see"
        );
    }
}
