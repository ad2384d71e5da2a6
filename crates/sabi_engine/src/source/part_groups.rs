//! Groups of the triangles of a model: parts, materials, charts, names, connected pieces.

use std::borrow::Cow;
use std::collections::BTreeMap;

use sabi_gpu::PartRows;
use sabi_graph::nearest;
use sabi_plan::pcg;

use super::id_color::{id_color, numbered_color};
use super::texels::SourceSurface;

/// Maximum number of names that a warning lists.
const LISTED: usize = 12;

/// Groups of the model's triangles.
pub(super) struct TriangleGroups {
    /// Noun for a group in sentences.
    noun: &'static str,
    /// Kind of things that are grouped by their numbers.
    pub(super) by: PartRows,
    /// Group of each part, if parts are grouped by their names; otherwise each part is a group.
    of_part: Option<Vec<u32>>,
    /// Names of each group; empty if groups have only numbers.
    names: Vec<Vec<String>>,
    /// Random number of each group.
    pub(super) random: Vec<u32>,
}

impl TriangleGroups {
    /// Groups triangles; `by` is the number of a choice of `surface/id`.
    pub(super) fn new(surface: &SourceSurface<'_>, by: usize) -> TriangleGroups {
        let (noun, of, names) = match by {
            1 => {
                let files = sabi_export::set_names(surface.model);
                let own = surface.model.materials.iter().map(|material| material.name.clone());
                let names = own.zip(files).map(|(own, file)| vec![own, file]);
                ("material", PartRows::Material, names.collect())
            }
            2 => ("chart", PartRows::Chart, Vec::new()),
            3 => return TriangleGroups::by_name(surface),
            4 => ("piece", PartRows::Piece, Vec::new()),
            5 => ("group", PartRows::Whole, Vec::new()),
            _ => {
                let names = surface.model.parts.iter().map(|name| vec![name.clone()]);
                ("part", PartRows::Part, names.collect())
            }
        };
        let last = numbers(surface, of).iter().max().map_or(0, |last| *last + 1);
        // Groups of different choices must not share random numbers.
        let random = (0..last).map(|number| pcg(pcg(number) ^ by as u32)).collect();
        TriangleGroups {
            noun,
            by: of,
            of_part: None,
            names,
            random,
        }
    }

    fn by_name(surface: &SourceSurface<'_>) -> TriangleGroups {
        let mut numbers: BTreeMap<&str, u32> = BTreeMap::new();
        for name in &surface.model.parts {
            let next = numbers.len() as u32;
            numbers.entry(name).or_insert(next);
        }
        // Every name has a number.
        let group_of = |name: &String| numbers.get(name.as_str()).copied().unwrap_or(0);
        let of_part = surface.model.parts.iter().map(group_of).collect();
        let mut sorted: Vec<(&str, u32)> = numbers.iter().map(|(name, number)| (*name, *number)).collect();
        sorted.sort_by_key(|(_, number)| *number);
        TriangleGroups {
            noun: "name",
            by: PartRows::Part,
            of_part: Some(of_part),
            names: sorted.iter().map(|(name, _)| vec![(*name).to_owned()]).collect(),
            random: sorted
                .iter()
                .map(|(name, _)| name.bytes().fold(0, |hash, byte| pcg(hash ^ u32::from(byte))))
                .collect(),
        }
    }

    /// The group of each triangle.
    pub(super) fn of_triangles(&self, surface: &SourceSurface<'_>) -> Vec<u32> {
        let group_of = |number: &u32| match &self.of_part {
            // Every part has a name.
            Some(of_part) => of_part.get(*number as usize).copied().unwrap_or(0),
            None => *number,
        };
        numbers(surface, self.by).iter().map(group_of).collect()
    }

    /// Returns the rows that the device reads: the rows of its group for each grouped thing.
    pub(super) fn rows<const N: usize>(&self, of_group: impl Fn(usize) -> [[f32; 4]; N]) -> Vec<[u32; 4]> {
        let bits = |row: [f32; 4]| row.map(f32::to_bits);
        let groups: Vec<usize> = match &self.of_part {
            Some(of_part) => of_part.iter().map(|group| *group as usize).collect(),
            None => (0..self.count()).collect(),
        };
        groups.into_iter().flat_map(|group| of_group(group).map(bits)).collect()
    }

    /// Returns a linear color for each group.
    pub(super) fn colors(&self) -> Vec<[f32; 3]> {
        let numbers = 0..self.count() as u32;
        match self.noun {
            // Colors by name depend only on the names.
            "name" => self.random.iter().map(|bits| id_color(*bits)).collect(),
            _ => numbers.map(numbered_color).collect(),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.random.len()
    }

    /// Returns the picked groups, and the words of `pick` that match no group.
    pub(super) fn picked<'p>(&self, pick: &'p str) -> (Vec<bool>, Vec<&'p str>) {
        let whole = pick.trim();
        if whole.is_empty() {
            return (vec![true; self.count()], Vec::new());
        }
        let mut picked = vec![false; self.count()];
        // A name may contain a comma.
        if self.mark(whole, &mut picked) {
            return (picked, Vec::new());
        }
        let words = whole.split(',').map(str::trim).filter(|word| !word.is_empty());
        let unknown = words.filter(|word| !self.mark(word, &mut picked)).collect();
        (picked, unknown)
    }

    /// Marks the groups of a name, a prefix or a number. Returns true if there are any.
    fn mark(&self, word: &str, picked: &mut [bool]) -> bool {
        if word == "*" {
            picked.fill(true);
            return true;
        }
        let is_meant = |name: &String| match word.strip_suffix('*') {
            Some(start) => name.starts_with(start),
            None => name == word,
        };
        let mut found = false;
        for (group, names) in self.names.iter().enumerate() {
            if names.iter().any(is_meant)
                && let Some(mark) = picked.get_mut(group)
            {
                *mark = true;
                found = true;
            }
        }
        if !found
            && let Ok(number) = word.parse::<usize>()
            && let Some(mark) = picked.get_mut(number)
        {
            *mark = true;
            found = true;
        }
        found
    }

    /// Warns about a word of `pick` that matches nothing.
    pub(super) fn unknown(&self, node: &str, word: &str) -> String {
        let (noun, count) = (self.noun, self.count());
        let mut known: Vec<&str> = self.names.iter().flatten().map(String::as_str).collect();
        known.retain(|name| !name.is_empty());
        known.dedup();
        let mut sentence = format!("node '{node}' picks '{word}', but the model has no such {noun}");
        if let Some(near) = nearest(word.trim_end_matches('*'), known.iter().copied()) {
            sentence += &format!("; did you mean '{near}'?");
        } else if known.is_empty() && count == 1 {
            sentence += "; there is one only, with the number 0";
        } else if known.is_empty() {
            sentence += &format!("; they are numbered from 0 to {}", count.saturating_sub(1));
        } else {
            let more = known.len().saturating_sub(LISTED);
            known.truncate(LISTED);
            sentence += &format!("; there are {}", known.join(", "));
            if more > 0 {
                sentence += &format!(" and {more} more");
            }
        }
        sentence
    }
}

/// Returns the number of each triangle in a division of the model.
fn numbers<'s>(surface: &SourceSurface<'s>, by: PartRows) -> Cow<'s, [u32]> {
    let mesh = &surface.model.mesh;
    match by {
        PartRows::Part => Cow::Borrowed(&mesh.triangle_part),
        PartRows::Material => Cow::Borrowed(&mesh.triangle_material),
        PartRows::Chart => {
            let triangles = 0..mesh.triangles.len();
            Cow::Owned(triangles.map(|triangle| surface.atlas.uv_chart(triangle)).collect())
        }
        PartRows::Piece => Cow::Borrowed(&surface.pieces.triangle_piece),
        PartRows::Whole => Cow::Owned(vec![0; mesh.triangles.len()]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(names: &[&str]) -> TriangleGroups {
        TriangleGroups {
            noun: "part",
            by: PartRows::Part,
            of_part: None,
            names: names.iter().map(|name| vec![(*name).to_owned()]).collect(),
            random: vec![0; names.len()],
        }
    }

    #[test]
    fn a_pick_takes_names_numbers_beginnings_and_lists_of_them() {
        let model = groups(&["seat", "leg left", "leg right", "bolt, long", "7"]);
        let cases: [(&str, &[usize], &[&str]); 10] = [
            ("", &[0, 1, 2, 3, 4], &[]),
            (" ", &[0, 1, 2, 3, 4], &[]),
            ("*", &[0, 1, 2, 3, 4], &[]),
            ("seat", &[0], &[]),
            ("1", &[1], &[]),
            ("leg*", &[1, 2], &[]),
            ("seat, leg right", &[0, 2], &[]),
            ("bolt, long", &[3], &[]),
            // A name wins over a number.
            ("7", &[4], &[]),
            ("seat, arm, 9", &[0], &["arm", "9"]),
        ];
        for (pick, expected, unknown) in cases {
            let (picked, left) = model.picked(pick);
            let picked: Vec<usize> = (0..picked.len()).filter(|group| picked[*group]).collect();
            assert_eq!((picked.as_slice(), left.as_slice()), (expected, unknown), "'{pick}'");
        }
    }

    #[test]
    fn a_pick_of_nothing_says_what_there_is() {
        let model = groups(&["seat", "leg"]);
        assert_eq!(
            model.unknown("tint", "seet"),
            "node 'tint' picks 'seet', but the model has no such part; did you mean 'seat'?"
        );
        assert_eq!(
            model.unknown("tint", "roof*"),
            "node 'tint' picks 'roof*', but the model has no such part; there are seat, leg"
        );
        let numbered = TriangleGroups {
            noun: "chart",
            names: Vec::new(),
            ..model
        };
        assert_eq!(
            numbered.unknown("tint", "12"),
            "node 'tint' picks '12', but the model has no such chart; they are numbered from 0 to 1"
        );
        let whole = TriangleGroups {
            noun: "group",
            random: vec![0],
            ..numbered
        };
        assert_eq!(
            whole.unknown("tint", "leg"),
            "node 'tint' picks 'leg', but the model has no such group; there is one only, with the number 0"
        );
    }
}
