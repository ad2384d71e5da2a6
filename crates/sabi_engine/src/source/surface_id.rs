//! `surface/id`: groups of triangles: parts, materials, charts, names, connected pieces.

use std::collections::BTreeMap;

use sabi_graph::{PortType, nearest};
use sabi_nodes::kind::Param;
use sabi_nodes::link::Plane;
use sabi_plan::{NoSuchValue, SourceKind, SourcePort, SourceStep, pcg};
use sabi_surface::model::Model;
use sabi_surface::pieces::{PieceBox, boxes};

use super::hash_apart;
use super::id_color::{id_color, numbered_color};
use super::texels::SourceSurface;

/// Id of the kind.
pub(crate) const NAME: &str = "surface/id";

/// Choices of `by`.
const WORDS: [&str; 6] = ["part", "material", "chart", "name", "piece", "whole"];
/// Maximum of names that a warning lists.
const LISTED: usize = 12;

/// Declares the kind.
pub(crate) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Parts".to_owned(),
        summary: "Divides the model into parts, or selects some of them.".to_owned(),
        aliases: ["part", "object", "select", "pick", "piece", "plank", "random", "island"]
            .map(str::to_owned)
            .to_vec(),
        params: vec![
            Param::choice(
                "by",
                &WORDS,
                "Division of the model: its parts, its materials, its UV charts, parts of the same name, connected \
                 pieces inside a part, such as single planks, or the whole model as one part.",
            ),
            Param::text(
                "pick",
                "",
                "Names or numbers (from 0) to select, separated by commas; a * at the end matches any ending, as in \
                 leg*. Empty selects everything. 'sabi mesh' lists the names.",
            ),
        ],
        inputs: Vec::new(),
        outputs: vec![
            SourcePort::new("mask", PortType::Mask, "1 on the selected parts, 0 elsewhere."),
            SourcePort::new(
                "id",
                PortType::Mask,
                "A random value for each part. With name, it depends on the name alone, so it stays the same when the \
                 order of the parts changes.",
            ),
            SourcePort::new(
                "color",
                PortType::Color,
                "A color for each part that tells it from its neighbors, as programs select parts by.",
            ),
            SourcePort::new(
                "position",
                PortType::Vector,
                "Position in the bounding box of each part: from the center of the box, x along its longest side.",
            ),
        ],
        content: [0; 32],
    }
}

/// Declares the kind for a model: with a hash of all names that can be picked and of their triangles.
pub(crate) fn kind_for(model: &Model) -> SourceKind {
    let mut hash = blake3::Hasher::new();
    let own = model.materials.iter().map(|material| &material.name);
    let files = sabi_export::set_names(model);
    for names in [
        model.parts.iter().collect::<Vec<_>>(),
        own.collect(),
        files.iter().collect(),
    ] {
        hash.update(&(names.len() as u64).to_le_bytes());
        for name in names {
            hash_apart(&mut hash, name.as_bytes());
        }
    }
    for groups in [&model.mesh.triangle_part, &model.mesh.triangle_material] {
        for group in groups {
            hash.update(&group.to_le_bytes());
        }
    }
    SourceKind {
        content: *hash.finalize().as_bytes(),
        ..kind()
    }
}

/// Groups of the model's triangles.
struct Groups {
    /// Noun for a group in sentences.
    noun: &'static str,
    /// Group of each triangle.
    of_triangle: Vec<u32>,
    /// Names of each group; empty where groups have numbers only.
    names: Vec<Vec<String>>,
    /// Random number of each group.
    random: Vec<u32>,
}

impl Groups {
    /// Groups triangles; `by` is an index into [`WORDS`].
    fn new(surface: &SourceSurface<'_>, by: usize) -> Groups {
        let mesh = &surface.model.mesh;
        let (noun, of_triangle, names) = match by {
            1 => {
                let files = sabi_export::set_names(surface.model);
                let own = surface.model.materials.iter().map(|material| material.name.clone());
                let names = own.zip(files).map(|(own, file)| vec![own, file]);
                ("material", mesh.triangle_material.clone(), names.collect())
            }
            2 => ("chart", surface.atlas.triangle_chart.clone(), Vec::new()),
            3 => return Groups::by_name(surface),
            4 => ("piece", surface.pieces.triangle_piece.clone(), Vec::new()),
            5 => ("group", vec![0; mesh.triangles.len()], Vec::new()),
            _ => {
                let names = surface.model.parts.iter().map(|name| vec![name.clone()]);
                ("part", mesh.triangle_part.clone(), names.collect())
            }
        };
        let last = of_triangle.iter().max().map_or(0, |last| *last + 1);
        // Groups of different choices must not share random numbers.
        let random = (0..last).map(|number| pcg(pcg(number) ^ by as u32)).collect();
        Groups {
            noun,
            of_triangle,
            names,
            random,
        }
    }

    fn by_name(surface: &SourceSurface<'_>) -> Groups {
        let mut numbers: BTreeMap<&str, u32> = BTreeMap::new();
        for name in &surface.model.parts {
            let next = numbers.len() as u32;
            numbers.entry(name).or_insert(next);
        }
        let group_of = |part: &u32| {
            let name = surface.model.parts.get(*part as usize);
            // Every part has a name, and every name a number.
            name.and_then(|name| numbers.get(name.as_str())).copied().unwrap_or(0)
        };
        let mut sorted: Vec<(&str, u32)> = numbers.iter().map(|(name, number)| (*name, *number)).collect();
        sorted.sort_by_key(|(_, number)| *number);
        Groups {
            noun: "name",
            of_triangle: surface.model.mesh.triangle_part.iter().map(group_of).collect(),
            names: sorted.iter().map(|(name, _)| vec![(*name).to_owned()]).collect(),
            random: sorted
                .iter()
                .map(|(name, _)| name.bytes().fold(0, |hash, byte| pcg(hash ^ u32::from(byte))))
                .collect(),
        }
    }

    /// Returns a linear color for each group.
    fn colors(&self) -> Vec<[f32; 3]> {
        let numbers = 0..self.count() as u32;
        match self.noun {
            // Those of names depend on the names alone.
            "name" => self.random.iter().map(|bits| id_color(*bits)).collect(),
            _ => numbers.map(numbered_color).collect(),
        }
    }

    fn count(&self) -> usize {
        self.random.len()
    }

    /// Returns the picked groups, and the words of `pick` that match none.
    fn picked<'p>(&self, pick: &'p str) -> (Vec<bool>, Vec<&'p str>) {
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

    /// Marks the groups of a name, a prefix or a number; returns whether there are any.
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
    fn unknown(&self, node: &str, word: &str) -> String {
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

/// Fills a plane of a result. Adds picked names that do not exist to `warnings`.
pub(crate) fn plane(
    surface: &SourceSurface<'_>,
    step: &SourceStep,
    output: &str,
    plane: Plane,
    warnings: &mut Vec<String>,
) -> Result<Vec<u8>, NoSuchValue> {
    let groups = Groups::new(surface, step.values.index("by")?);
    if output == "color" {
        let colors = groups.colors();
        return Ok(surface.texels(plane, |point| {
            let [r, g, b] = colors[groups.of_triangle[point.triangle] as usize];
            [r, g, b, 1.0]
        }));
    }
    let of_group: Vec<f32> = match output {
        "position" => {
            let boxes = boxes(&surface.model.mesh, &groups.of_triangle, groups.count());
            return Ok(surface.texels(plane, |point| {
                let own = &boxes[groups.of_triangle[point.triangle] as usize];
                let [x, y, z] = place_in(own, surface.working_from_model, surface.position(point).to_array());
                [x, y, z, 1.0]
            }));
        }
        "id" => {
            let unit = |bits: &u32| (bits >> 8) as f32 / 16_777_216.0;
            groups.random.iter().map(unit).collect()
        }
        _ => {
            let (picked, unknown) = groups.picked(step.values.text("pick")?);
            warnings.extend(unknown.iter().map(|word| groups.unknown(&step.id, word)));
            picked.iter().map(|is_picked| f32::from(u8::from(*is_picked))).collect()
        }
    };
    Ok(surface.texels(plane, |point| {
        let group = groups.of_triangle[point.triangle] as usize;
        [of_group[group], 0.0, 0.0, 1.0]
    }))
}

/// Transforms a position in working units to the axes of a box, relative to its center.
fn place_in(own: &PieceBox, working_from_model: f64, place: [f64; 3]) -> [f32; 3] {
    let away: [f64; 3] = std::array::from_fn(|axis| place[axis] - f64::from(own.center[axis]) * working_from_model);
    own.axes.map(|side| {
        let along: f64 = side.iter().zip(away).map(|(side, away)| f64::from(*side) * away).sum();
        along as f32
    })
}

#[cfg(test)]
mod tests {
    use sabi_surface::model::Model;

    use super::{Groups, kind_for};

    #[test]
    fn models_that_differ_in_names_alone_share_no_result() {
        let of = |parts: &[&str]| {
            kind_for(&Model {
                parts: parts.iter().map(|name| (*name).to_owned()).collect(),
                ..Model::default()
            })
            .content
        };
        assert_eq!(of(&["leg", "seat"]), of(&["leg", "seat"]));
        assert_ne!(of(&["leg", "seat"]), of(&["seat", "leg"]));
        assert_ne!(of(&["ab", "c"]), of(&["a", "bc"]));
    }

    fn groups(names: &[&str]) -> Groups {
        Groups {
            noun: "part",
            of_triangle: Vec::new(),
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
        let numbered = Groups {
            noun: "chart",
            names: Vec::new(),
            ..model
        };
        assert_eq!(
            numbered.unknown("tint", "12"),
            "node 'tint' picks '12', but the model has no such chart; they are numbered from 0 to 1"
        );
        let whole = Groups {
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
