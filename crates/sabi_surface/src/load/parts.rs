//! Choice of the parts of a file to load. Collision hulls and coarser levels of detail lie at the same place as the visible
//! model. They are recognized by naming conventions of game engines.

mod name_meaning;
mod node_groups;

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use self::name_meaning::{NameMeaning, by_names};
pub(super) use self::node_groups::{NamedPart, NodeGroups};
use super::error::ModelFault;
use super::warnings::Warnings;
use crate::model::{ExclusionReason, FilePart};

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

    /// Returns the parts of a file by their names and those of the `groups` above them, each with whether it is taken.
    ///
    /// # Errors
    /// No part has a chosen name, or the choice excludes all parts.
    pub(super) fn of_file<'n>(
        &self,
        parts: impl Iterator<Item = NamedPart<'n>>,
        groups: &NodeGroups,
        warnings: &mut Warnings,
    ) -> Result<Vec<FilePart>, ModelFault> {
        let parts: Vec<NamedPart> = parts.collect();
        let choosable = Choosable::new(&parts, groups);
        self.check_names(&choosable, warnings)?;
        let [chosen, excluded] = [&self.parts, &self.without].map(|patterns| choosable.named(patterns));
        let is_all = self.parts.is_empty();
        let choices = chosen.into_iter().zip(excluded);
        let part = |((part, by_name), (is_chosen, is_excluded)): ((&NamedPart, Option<NameMeaning>), (bool, bool))| {
            let is_out = !is_all && !is_chosen || is_excluded;
            let is_usual = by_name.is_none();
            let by_name = by_name.filter(|_| is_all && !is_out);
            let by_choice = is_out.then_some(ExclusionReason::Chosen);
            FilePart {
                name: part.name.to_owned(),
                left_out: by_choice.or(by_name.as_ref().map(|meaning| meaning.left_out)),
                of_group: by_name.and_then(|meaning| meaning.of_group),
                is_usual,
            }
        };
        let named = parts.iter().zip(by_names(&parts, groups));
        let parts: Vec<FilePart> = named.zip(choices).map(part).collect();
        if !parts.is_empty() && parts.iter().all(|part| part.left_out.is_some()) {
            return Err(ModelFault::NoPart);
        }
        Ok(parts)
    }

    /// Refuses names that no part has. A pattern of excluded parts may match nothing.
    fn check_names(&self, choosable: &Choosable, warnings: &mut Warnings) -> Result<(), ModelFault> {
        let is_used = |pattern: &str| choosable.has(pattern);
        let (patterns, plain): (Vec<&String>, Vec<&String>) = self.without.iter().partition(|name| is_pattern(name));
        let mut unknown: Vec<String> = Vec::new();
        for name in self.parts.iter().chain(plain).filter(|name| !is_used(name)) {
            if !unknown.contains(name) {
                unknown.push(name.clone());
            }
        }
        if !unknown.is_empty() {
            let there: BTreeSet<String> = choosable.parts.iter().map(|part| part.name.to_owned()).collect();
            return Err(ModelFault::NoSuchPart {
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

/// Parts of a file and the nodes above them, as a choice may name them.
struct Choosable<'c> {
    parts: &'c [NamedPart<'c>],
    groups: &'c NodeGroups,
    /// Parts below each node.
    counts: Vec<usize>,
}

impl<'c> Choosable<'c> {
    fn new(parts: &'c [NamedPart<'c>], groups: &'c NodeGroups) -> Choosable<'c> {
        Choosable {
            counts: groups.counts(parts),
            parts,
            groups,
        }
    }

    /// Returns true if a pattern stands for a node: for one that is no part itself and has parts below it. That of a
    /// whole file is meant only where its full name is given.
    fn is_group(&self, pattern: &str, number: usize) -> bool {
        let group = &self.groups.all()[number];
        let count = self.counts[number];
        let is_apart = count > 0 && (count < self.parts.len() || !is_pattern(pattern));
        !group.is_part && is_apart && matches(pattern, &group.name)
    }

    /// Returns true if a pattern stands for anything.
    fn has(&self, pattern: &str) -> bool {
        let is_part = self.parts.iter().any(|part| matches(pattern, part.name));
        is_part || (0..self.counts.len()).any(|number| self.is_group(pattern, number))
    }

    /// Returns for each part whether one of the patterns stands for it or for a node above it.
    fn named(&self, patterns: &[String]) -> Vec<bool> {
        let of_groups = self.groups.inherited(|number, _| {
            let is_named = patterns.iter().any(|pattern| self.is_group(pattern, number));
            is_named.then_some(())
        });
        let is_named = |part: &NamedPart| {
            let is_below = part.group.is_some_and(|group| of_groups[group].is_some());
            is_below || patterns.iter().any(|pattern| matches(pattern, part.name))
        };
        self.parts.iter().map(is_named).collect()
    }
}

/// Returns true if a name has letters that stand for others.
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

#[cfg(test)]
mod tests {
    use super::*;

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
            let parts = names.iter().map(|name| NamedPart { name, group: None });
            let parts = choice.of_file(parts, &NodeGroups::default(), &mut Warnings::default())?;
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
        assert_eq!(taken(&[], &["*"]), Err(ModelFault::NoPart));
        let mut there = all();
        there.sort();
        assert_eq!(
            taken(&["Rok", "Stone*"], &["Mos", "Moss"]),
            Err(ModelFault::NoSuchPart {
                unknown: vec!["Rok".into(), "Stone*".into(), "Mos".into()],
                there,
            })
        );
    }

    #[test]
    fn a_node_is_chosen_with_all_parts_below_it() {
        let mut groups = NodeGroups::default();
        let root = groups.add("Scene", None, false);
        let wheels = groups.add("Wheels", Some(root), false);
        let front = groups.add("Wheels_Front", Some(wheels), false);
        groups.add("Lamps", Some(root), false);
        let body = groups.add("Body", Some(root), true);
        let parts = [("Body", root), ("rim", wheels), ("tire", front), ("Badge", body)];
        let taken = |parts_of: &[&str], without: &[&str]| {
            let list = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
            let choice = PartChoice {
                parts: list(parts_of),
                without: list(without),
            };
            let parts = parts.iter().map(|(name, group)| NamedPart {
                name,
                group: Some(*group),
            });
            let mut warnings = Warnings::default();
            let parts = choice.of_file(parts, &groups, &mut warnings)?;
            let taken = parts.into_iter().filter(|part| part.left_out.is_none());
            Ok(taken.map(|part| part.name).collect::<Vec<String>>().join(" "))
        };
        assert_eq!(taken(&["Wheels"], &[]), Ok("rim tire".to_owned()));
        assert_eq!(taken(&["Wheels"], &["*_Front"]), Ok("rim".to_owned()));
        assert_eq!(taken(&[], &["Wheels_*"]), Ok("Body rim Badge".to_owned()));
        assert_eq!(
            taken(&[], &["Body"]),
            Ok("rim tire Badge".to_owned()),
            "a part is itself alone"
        );
        assert_eq!(taken(&["Scene"], &["tire"]), Ok("Body rim Badge".to_owned()));
        assert_eq!(
            taken(&[], &["S*"]),
            Ok("Body rim tire Badge".to_owned()),
            "a star means no whole file"
        );
        let unknown = taken(&["Lamps"], &[]).unwrap_err();
        assert!(
            matches!(unknown, ModelFault::NoSuchPart { .. }),
            "nothing is below it: {unknown}"
        );
    }
}
