//! Texture sets of a model, and the nodes that serve them.

use std::collections::{BTreeMap, BTreeSet};

use sabi_export::{SetKey, set_keys, set_names, sheet_names};
use sabi_graph::{FlatGraph, advice_on};
use sabi_surface::atlas::Atlas;
use sabi_surface::model::Model;

use crate::error::{EngineError, ErrorKind};
use crate::evaluating::outputs::{map_outputs, materials, outputs, quoted, serving_outputs, unused_outputs};
use crate::opening::document::OpenGraph;
use crate::opening::linked_model::LinkedModel;
use crate::remedy::Remedy;
use crate::warning::Warning;

/// Maximum number of materials that an error lists.
const MOST_LISTED: usize = 12;

/// Texture set of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSet {
    /// Key of the set.
    pub key: SetKey,
    /// Stem of its file names.
    pub name: String,
}

impl TextureSet {
    /// Returns a name that is unique among the sets: the stem, and the tile number if its material has several tiles.
    pub fn title(&self) -> String {
        match self.key.udim {
            Some(number) => format!("{} {number}", self.name),
            None => self.name.clone(),
        }
    }
}

/// Lists the sets of all materials, or of those with the wanted name or stem. There is at least one.
pub(crate) fn texture_sets(model: &Model, atlas: &Atlas, wanted: Option<&str>) -> Result<Vec<TextureSet>, EngineError> {
    let stems = sheet_names(model);
    let covering = atlas.charts.iter().filter(|chart| chart.texels > 0);
    let covered: BTreeSet<u32> = covering.map(|chart| chart.sheet).collect();
    let mut keys = set_keys(atlas);
    keys.retain(|key| covered.contains(&key.material));
    let names = |key: &SetKey| {
        let [name, stem] = names_of(model, &stems, key.material);
        if model.mesh.is_one_sheet {
            [stem, stem]
        } else {
            [name, stem]
        }
    };
    let chosen = keys
        .iter()
        .filter(|key| wanted.is_none_or(|wanted| names(key).contains(&wanted)));
    let sets: Vec<TextureSet> = chosen
        .map(|key| TextureSet {
            key: *key,
            name: names(key)[1].to_owned(),
        })
        .collect();
    match wanted {
        _ if !sets.is_empty() => Ok(sets),
        Some(wanted) => {
            let mut known: Vec<&str> = keys.iter().map(|key| names(key)[1]).collect();
            known.dedup();
            let advice = match known.len() {
                ..=MOST_LISTED => format!("it has {}", known.join(", ")),
                _ => advice_on(wanted, known),
            };
            let why = format!("the model has no material '{wanted}'; {advice}");
            Err(EngineError::new(ErrorKind::Usage, why))
        }
        None => Err(EngineError::new(
            ErrorKind::BadInput,
            "the model has no surface that maps could be made for",
        )),
    }
}

/// Lists the materials in use, in ascending order.
fn used_materials(atlas: &Atlas) -> Vec<u32> {
    let used: BTreeSet<u32> = atlas.charts.iter().map(|chart| chart.material).collect();
    used.into_iter().collect()
}

/// Returns a warning for each material that gets no maps because none of its surface reaches a texel.
pub(crate) fn materials_without_maps(model: &Model, atlas: &Atlas) -> Vec<Warning> {
    let stems = set_names(model);
    let mut bare = used_materials(atlas);
    let covering = atlas.charts.iter().filter(|chart| chart.texels > 0);
    let covered: BTreeSet<u32> = covering.map(|chart| chart.material).collect();
    bare.retain(|material| !covered.contains(material));
    let warning = |material: u32| {
        let [name, _] = names_of(model, &stems, material);
        let sentence = format!("the material '{name}' gets no maps: its UVs cover no texel");
        let remedies: &[Remedy] = match model.mesh.is_one_sheet {
            true => &[Remedy::LargerSize],
            false => &[Remedy::UnwrapModel, Remedy::LargerSize],
        };
        Warning::new(sentence, remedies.iter().copied())
    };
    bare.into_iter().map(warning).collect()
}

/// Returns the name of a material (its stem if it has no name), and its stem.
fn names_of<'m>(model: &'m Model, stems: &'m [String], material: u32) -> [&'m str; 2] {
    let index = material as usize;
    let stem = stems.get(index).map_or(model.stem.as_str(), String::as_str);
    let own = model.materials.get(index).map_or("", |material| material.name.as_str());
    [if own.is_empty() { stem } else { own }, stem]
}

/// Returns a warning that says which of several sets a preview shows; `None` if there is only one.
pub(crate) fn shown_set_warning(sets: &[TextureSet]) -> Option<Warning> {
    let first = sets.first().filter(|_| sets.len() > 1)?;
    let tile = first
        .key
        .udim
        .map_or(String::new(), |number| format!("tile {number} of "));
    let name = &first.name;
    Some(if sets.iter().all(|set| set.key.material == first.key.material) {
        let sentence = format!("this shows {tile}'{name}', the first of its {} tiles", sets.len());
        Warning::from(sentence)
    } else {
        let sentence = format!("this shows {tile}'{name}', the first of {} texture sets", sets.len());
        Warning::new(sentence, [Remedy::OtherMaterial])
    })
}

/// Returns a warning about a material that no output serves.
fn unserved_warning(name: &str) -> String {
    format!(
        "the material '{name}' keeps the maps it has, since no output serves it; to bake it, list it in 'materials' of an \
         output"
    )
}

/// Nodes that serve the materials of each texture set.
#[derive(Debug, PartialEq)]
pub(crate) struct OutputAssignment {
    /// Node by material for each set: an output, or [`OutputAssignment::model_source`]. Empty for a set that no output serves.
    pub(crate) nodes: Vec<BTreeMap<u32, usize>>,
    /// Index of the node of the model's own materials, which has yet to be appended, if a part of a sheet needs it.
    pub(crate) model_source: Option<usize>,
    /// Warnings about probable mistakes.
    pub(crate) warnings: Vec<Warning>,
}

/// Finds the outputs that serve the sets. `outputs` are those of the graph. On a shared sheet, materials that no output
/// serves keep their own look.
pub(crate) fn assign_outputs(
    open: &OpenGraph,
    graph: &FlatGraph,
    outputs: &[usize],
    model: &Model,
    atlas: &Atlas,
    sets: &[TextureSet],
) -> Result<OutputAssignment, EngineError> {
    let stems = set_names(model);
    let used = used_materials(atlas);
    let names: Vec<[&str; 2]> = used.iter().map(|&index| names_of(model, &stems, index)).collect();
    let by_material = serving_outputs(graph, outputs, &names);
    let found = used.iter().zip(&by_material);
    let found: BTreeMap<u32, usize> = found.filter_map(|(&index, &output)| Some((index, output?))).collect();
    let is_one_sheet = model.mesh.is_one_sheet;
    let mut unserved: Vec<u32> = match is_one_sheet {
        true => used.clone(),
        false => sets.iter().map(|set| set.key.material).collect(),
    };
    unserved.dedup();
    unserved.retain(|material| !found.contains_key(material));
    let shows_model = is_one_sheet && !found.is_empty() && !unserved.is_empty();
    let own = shows_model.then_some(graph.nodes.len());
    let of_set = |set: &TextureSet| -> BTreeMap<u32, usize> {
        let own = unserved.iter().filter_map(|&material| Some((material, own?)));
        let found = found.iter().map(|(&material, &output)| (material, output));
        let is_there = |(material, _): &(u32, usize)| is_one_sheet || *material == set.key.material;
        found.chain(own).filter(is_there).collect()
    };
    let nodes: Vec<BTreeMap<u32, usize>> = sets.iter().map(of_set).collect();
    let name = |&material: &u32| names_of(model, &stems, material)[0];
    if nodes.iter().all(BTreeMap::is_empty) && map_outputs(graph, outputs).is_empty() {
        let (unserved, has) = (quoted(unserved.iter().map(name)), quoted(used.iter().map(name)));
        let why = format!(
            "no output serves {unserved}, so there is nothing to bake; the model has {has}: list one of them in 'materials' of an output"
        );
        return Err(EngineError::new(ErrorKind::BadInput, open.with_path(why)));
    }
    let mut sentences = unused_outputs(graph, outputs, &names);
    if !materials(graph, outputs).is_empty() {
        sentences.extend(unserved.iter().map(name).map(unserved_warning));
    }
    let warnings = sentences.into_iter().map(Warning::from).collect();
    Ok(OutputAssignment {
        nodes,
        model_source: own,
        warnings,
    })
}

/// Finds the node that each material shows: the output that serves it, or otherwise the node of the model's own materials,
/// which has yet to be appended. Also returns warnings about outputs that serve no material.
pub(crate) fn assign_shown_nodes(graph: &FlatGraph, linked: &LinkedModel) -> (BTreeMap<u32, usize>, Vec<String>) {
    let LinkedModel { model, atlas, .. } = linked;
    let outputs = outputs(graph);
    let stems = set_names(model);
    let used = used_materials(atlas);
    let names: Vec<[&str; 2]> = used.iter().map(|&index| names_of(model, &stems, index)).collect();
    let by_material = serving_outputs(graph, &outputs, &names);
    let shown = used.iter().zip(by_material);
    // The node of the model's own materials will be appended at the end.
    let shown = shown.map(|(&material, output)| (material, output.unwrap_or(graph.nodes.len())));
    (shown.collect(), unused_outputs(graph, &outputs, &names))
}

#[cfg(test)]
mod tests {
    use sabi_export::SetKey;

    use super::{TextureSet, shown_set_warning};

    #[test]
    fn a_preview_of_one_of_several_sets_says_which() {
        let set = |material: u32, name: &str, udim: Option<u32>| TextureSet {
            key: SetKey {
                material,
                uv_tile: [0, 0],
                udim,
            },
            name: name.to_owned(),
        };
        let wood = [set(0, "wood", Some(1001)), set(0, "wood", Some(1002))];
        let cases = [
            (vec![set(0, "wood", None)], None),
            (
                wood.to_vec(),
                Some("this shows tile 1001 of 'wood', the first of its 2 tiles"),
            ),
            (
                [wood.to_vec(), vec![set(1, "steel", None)]].concat(),
                Some("this shows tile 1001 of 'wood', the first of 3 texture sets; choose another material"),
            ),
        ];
        for (sets, words) in cases {
            let warning = shown_set_warning(&sets).map(|warning| warning.to_string());
            assert_eq!(warning.as_deref(), words);
        }
    }
}
