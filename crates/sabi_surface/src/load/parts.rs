//! Choice of the parts of a file to load. Collision hulls and coarser levels of detail lie at the same place as the visible
//! model. They are recognized by naming conventions of game engines.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::error::Fault;
use super::warnings::Warnings;
use crate::model::{FilePart, LeftOut};

/// Choice of parts by name, where `*` stands for any text and `?` for one letter.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PartChoice {
    /// Parts that are loaded, whatever their names mean. If empty, all parts except hulls and coarser levels of detail are loaded.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<String>,
    /// Parts that are excluded from these.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<String>,
}

impl PartChoice {
    /// Name that stands for all parts, including hulls and coarser levels of detail.
    pub const ALL: &str = "*";

    /// All parts of a file.
    pub fn all() -> PartChoice {
        PartChoice {
            parts: vec![PartChoice::ALL.to_owned()],
            without: Vec::new(),
        }
    }

    /// Returns true if the user has chosen nothing, so that naming conventions decide.
    pub fn is_default(&self) -> bool {
        *self == PartChoice::default()
    }

    /// Returns the parts of a file by their names, each with whether it is taken.
    ///
    /// # Errors
    /// No part has a chosen name, or the choice excludes all parts.
    pub(super) fn of_file<'n>(
        &self,
        names: impl Iterator<Item = &'n str>,
        warnings: &mut Warnings,
    ) -> Result<Vec<FilePart>, Fault> {
        let names: Vec<&str> = names.collect();
        self.check_names(&names, warnings)?;
        let is_any = |patterns: &[String], name: &str| patterns.iter().any(|pattern| matches(pattern, name));
        let by_names = by_names(&names);
        let part = |(name, by_name): (&&str, Option<LeftOut>)| {
            let is_chosen = self.parts.is_empty() || is_any(&self.parts, name);
            let is_out = !is_chosen || is_any(&self.without, name);
            let by_choice = is_out.then_some(LeftOut::Chosen);
            FilePart {
                name: (*name).to_owned(),
                left_out: by_choice.or(by_name.filter(|_| self.parts.is_empty())),
                is_usual: by_name.is_none(),
            }
        };
        let parts: Vec<FilePart> = names.iter().zip(by_names).map(part).collect();
        if !parts.is_empty() && parts.iter().all(|part| part.left_out.is_some()) {
            return Err(Fault::NoPart);
        }
        Ok(parts)
    }

    /// Refuses names that no part has. A pattern of excluded parts may match nothing.
    fn check_names(&self, names: &[&str], warnings: &mut Warnings) -> Result<(), Fault> {
        let is_used = |pattern: &str| names.iter().any(|name| matches(pattern, name));
        let (patterns, plain): (Vec<&String>, Vec<&String>) = self.without.iter().partition(|name| is_pattern(name));
        let mut unknown: Vec<String> = Vec::new();
        for name in self.parts.iter().chain(plain).filter(|name| !is_used(name)) {
            if !unknown.contains(name) {
                unknown.push(name.clone());
            }
        }
        if !unknown.is_empty() {
            let there: BTreeSet<String> = names.iter().map(|name| (*name).to_owned()).collect();
            return Err(Fault::NoSuchPart {
                unknown,
                there: there.into_iter().collect(),
            });
        }
        for pattern in patterns.into_iter().filter(|pattern| !is_used(pattern)) {
            warnings.add(format!("No part fits `{pattern}`, so it leaves none out."));
        }
        Ok(())
    }
}

/// Returns true if a name contains wildcards.
fn is_pattern(name: &str) -> bool {
    name.contains(['*', '?'])
}

/// Returns true if a pattern matches a whole name. Case matters.
fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    let (mut at, mut read) = (0, 0);
    // Position after the last star, and the length of the text that it matched so far. If the rest does not match, only
    // this star has to match more.
    let mut star: Option<(usize, usize)> = None;
    while read < name.len() {
        match pattern.get(at) {
            Some('*') => {
                at += 1;
                star = Some((at, read));
            }
            Some(letter) if *letter == '?' || *letter == name[read] => (at, read) = (at + 1, read + 1),
            _ => {
                let Some((after, taken)) = star else { return false };
                star = Some((after, taken + 1));
                (at, read) = (after, taken + 1);
            }
        }
    }
    pattern[at..].iter().all(|letter| *letter == '*')
}

/// Returns for each part why its name excludes it. If all parts would be excluded, none is.
fn by_names(names: &[&str]) -> Vec<Option<LeftOut>> {
    let plain: Vec<&str> = names.iter().map(|name| without_number(name)).collect();
    let known: BTreeSet<String> = plain.iter().map(|name| name.to_lowercase()).collect();
    let is_hull: Vec<bool> = plain.iter().map(|name| is_hull(name, &known)).collect();
    let levels: Vec<Option<(String, u32)>> = plain.iter().map(|name| level(name)).collect();
    let mut finest: BTreeMap<&str, u32> = BTreeMap::new();
    let seen = levels.iter().zip(&is_hull).filter(|(_, is_hull)| !**is_hull);
    for (of, level) in seen.filter_map(|(level, _)| level.as_ref()) {
        // A part with the bare name is finer than all numbered levels.
        let level = if known.contains(of) { 0 } else { *level };
        let least = finest.entry(of).or_insert(level);
        *least = level.min(*least);
    }
    let left_out = |(is_hull, level): (&bool, &Option<(String, u32)>)| {
        let is_coarser = |(of, level): &(String, u32)| finest.get(of.as_str()).is_some_and(|finest| level > finest);
        match (is_hull, level) {
            (true, _) => Some(LeftOut::Hull),
            (false, Some(level)) if is_coarser(level) => Some(LeftOut::CoarserLevel),
            _ => None,
        }
    };
    let found: Vec<Option<LeftOut>> = is_hull.iter().zip(&levels).map(left_out).collect();
    if found.iter().all(Option::is_some) {
        return vec![None; names.len()];
    }
    found
}

/// Returns a name without the number that programs append to distinguish names: `.001`.
fn without_number(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((before, digits)) if digits.len() == 3 && digits.bytes().all(|digit| digit.is_ascii_digit()) => before,
        _ => name,
    }
}

/// Prefixes of collision hulls in Unreal, lower case.
const HULL_PREFIXES: [&str; 4] = ["ucx_", "ubx_", "usp_", "ucp_"];
/// Endings of objects that Godot and Unity use but do not draw, lower case.
const HULL_ENDINGS: [&str; 6] = ["colonly", "convcolonly", "occonly", "navmesh", "collider", "collision"];
/// Endings with which Godot makes a hull from a part that it also draws, unless a part with the bare name exists.
const DRAWN_HULL_ENDINGS: [&str; 2] = ["col", "convcol"];
/// Characters that may come before these endings.
const BEFORE_ENDING: [char; 5] = ['-', '_', '$', '.', ' '];

/// Returns true if a part is a collision hull by its name; `known` are the names of all parts, lower case.
fn is_hull(name: &str, known: &BTreeSet<String>) -> bool {
    let name = name.to_lowercase();
    if HULL_PREFIXES.iter().any(|prefix| name.starts_with(prefix)) {
        return true;
    }
    // Godot ignores digits at the end.
    let name = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let Some((bare, ending)) = name.rsplit_once(BEFORE_ENDING) else {
        return false;
    };
    HULL_ENDINGS.contains(&ending) || DRAWN_HULL_ENDINGS.contains(&ending) && known.contains(bare)
}

/// Returns the level of detail in a name such as `Rock_LOD1`, with the rest of the name in lower case; `None` for other names.
fn level(name: &str) -> Option<(String, u32)> {
    let name = name.to_lowercase();
    let is_apart = |letter: Option<char>| letter.is_none_or(|letter| BEFORE_ENDING.contains(&letter));
    let (at, digits) = name.rmatch_indices("lod").find_map(|(at, word)| {
        let after = &name[at + word.len()..];
        let digits = after.len() - after.trim_start_matches(|letter: char| letter.is_ascii_digit()).len();
        let is_word = is_apart(name[..at].chars().next_back()) && is_apart(after[digits..].chars().next());
        (digits > 0 && is_word).then_some((at, digits))
    })?;
    let end = at + "lod".len() + digits;
    let level = name[end - digits..end].parse().ok()?;
    let before = name[..at].strip_suffix(BEFORE_ENDING).unwrap_or(&name[..at]);
    Some((format!("{before}{}", &name[end..]), level))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left_out(names: &[&str]) -> Vec<String> {
        let parts = PartChoice::default().of_file(names.iter().copied(), &mut Warnings::default());
        let parts = parts.expect("no name is asked for");
        let out = parts.into_iter().filter(|part| part.left_out.is_some());
        out.map(|part| part.name).collect()
    }

    #[test]
    fn only_the_finest_level_of_each_name_is_kept() {
        let cases: [(&[&str], &[&str]); 10] = [
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
            (&["Explode1", "Explode2", "Melody_LODge1"], &[]),
            (&["x_LOD99999999999", "x_LOD1"], &[]),
        ];
        for (names, expected) in cases {
            assert_eq!(left_out(names), expected, "{names:?}");
        }
    }

    #[test]
    fn collision_hulls_by_engine_conventions_are_left_out() {
        let cases: [(&[&str], &[&str]); 6] = [
            (
                &["Rock", "UCX_Rock_00", "ubx_Rock", "USP_Rock", "UCP_Rock.001"],
                &["UCX_Rock_00", "ubx_Rock", "USP_Rock", "UCP_Rock.001"],
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
            // Godot draws `Door-col` and also makes a hull from it.
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
    fn names_may_contain_wildcards() {
        for (pattern, name, fits) in [
            ("*", "", true),
            ("*", "Rock", true),
            ("Rock*", "Rock_LOD1", true),
            ("*LOD?", "Rock_LOD1", true),
            ("*LOD?", "Rock_LOD10", false),
            ("R*k*1", "Rock_k_LOD1", true),
            ("rock", "Rock", false),
            ("Rock", "Rock", true),
            ("Rock?", "Rock", false),
            ("Wheel[1]", "Wheel[1]", true),
            ("a,?", "a,b", true),
        ] {
            assert_eq!(matches(pattern, name), fits, "{pattern} {name}");
        }
        // The number of steps is letters times stars, not exponential.
        assert!(!matches(&"*a".repeat(100), &"a".repeat(99)));
    }

    #[test]
    fn a_choice_by_name_overrides_naming_conventions() {
        let names = ["Rock", "Rock_LOD1", "UCX_Rock", "Moss"];
        let taken = |parts: &[&str], without: &[&str]| {
            let list = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
            let choice = PartChoice {
                parts: list(parts),
                without: list(without),
            };
            let parts = choice.of_file(names.iter().copied(), &mut Warnings::default())?;
            let taken = parts.into_iter().filter(|part| part.left_out.is_none());
            Ok(taken.map(|part| part.name).collect::<Vec<String>>())
        };
        let all = || names.map(str::to_owned).to_vec();
        assert_eq!(taken(&["*"], &[]), Ok(all()));
        assert_eq!(
            taken(&["Rock_*", "Moss"], &[]),
            Ok(vec!["Rock_LOD1".into(), "Moss".into()])
        );
        assert_eq!(
            taken(&["*"], &["UCX_*", "Moss"]),
            Ok(vec!["Rock".into(), "Rock_LOD1".into()])
        );
        assert_eq!(taken(&[], &["Moss"]), Ok(vec!["Rock".to_owned()]));
        assert_eq!(taken(&[], &["Stone*"]), Ok(vec!["Rock".to_owned(), "Moss".to_owned()]));
        assert_eq!(taken(&[], &["*"]), Err(Fault::NoPart));
        let mut there = all();
        there.sort();
        assert_eq!(
            taken(&["Rok", "Stone*"], &["Mos", "Moss"]),
            Err(Fault::NoSuchPart {
                unknown: vec!["Rok".into(), "Stone*".into(), "Mos".into()],
                there,
            })
        );
    }
}
