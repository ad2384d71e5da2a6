//! Warnings about UVs outside of the unit square: surfaces that were unwrapped since they repeat, and tiles that could be UDIM.

use std::collections::{BTreeMap, BTreeSet};

use sabi_export::set_names;
use sabi_surface::atlas::{Udim, UvChart, udim_number};

use crate::opening::linked_model::LinkedModel;
use crate::remedy::Remedy;
use crate::warning::Warning;

/// Maximum part of a tile by which a chart may extend into the next tile and still belong to its own.
const OVERREACH: f64 = 0.01;

/// Warns about the tiles of a model's UVs.
pub(super) fn warnings(linked: &LinkedModel) -> Vec<Warning> {
    let names = set_names(&linked.model);
    // Each material has a name.
    let name = |material: u32| names.get(material as usize).map_or("", String::as_str);
    let repeats = unwrapped(linked, name).into_iter();
    repeats.chain(taken_for_repeating(linked, name)).collect()
}

/// Warns about surfaces that were unwrapped since their UVs repeat.
fn unwrapped<'n>(linked: &LinkedModel, name: impl Fn(u32) -> &'n str) -> Option<Warning> {
    let most = linked.repeats.iter().map(|repeats| repeats.times).reduce(f64::max)?;
    let names = linked
        .repeats
        .iter()
        .map(|repeats| format!("'{}'", name(repeats.material)));
    let which = names.collect::<Vec<_>>().join(", ");
    let onto = match linked.repeats.len() {
        1 => "the surface was unwrapped onto a sheet of its own",
        _ => "the surfaces were unwrapped, each onto a sheet of its own",
    };
    let sentence = format!(
        "the UVs of {which} repeat so often that they cover the area of a map {most:.0} times, and a map has one value for all places \
         that share a texel; so {onto}, and the maps fit the UVs that a copy of the model gets, not its own"
    );
    Some(Warning::new(sentence, [Remedy::KeepOwnUvs]))
}

/// Warns about tiles that were treated as a repeating texture although they could be UDIM.
fn taken_for_repeating<'n>(linked: &LinkedModel, name: impl Fn(u32) -> &'n str) -> Vec<Warning> {
    if linked.udim != Udim::Auto || linked.model.mesh.is_one_sheet {
        return Vec::new();
    }
    let mut charts: BTreeMap<u32, Vec<UvChart<'_>>> = BTreeMap::new();
    for chart in linked.atlas.uv_charts() {
        let sheet = chart.parts.first().map(|part| part.sheet);
        if let Some(sheet) = sheet.filter(|_| chart.texels() > 0) {
            charts.entry(sheet).or_default().push(chart);
        }
    }
    let warning = |(sheet, charts): (u32, Vec<UvChart<'_>>)| {
        let tiles: BTreeSet<[i32; 2]> = charts.iter().map(|chart| chart.parts[0].uv_tile).collect();
        let has_numbers = tiles.iter().all(|tile| udim_number(*tile).is_some());
        let is_told_apart = linked.atlas.udim_sheets.contains(&sheet);
        let within = || charts.iter().all(|chart| is_within_its_tile(chart, linked.atlas.size));
        if tiles.len() < 2 || !has_numbers || is_told_apart || !within() {
            return None;
        }
        let why = match linked.model.mesh.repeating.contains(&sheet) {
            true => "a texture of this material repeats",
            false => "most of them lie alike in several tiles",
        };
        let sentence = format!(
            "the UVs of '{}' lie in {} tiles, which share one set of maps, since {why}",
            name(sheet),
            tiles.len()
        );
        Some(Warning::new(sentence, [Remedy::TilesAsUdim]))
    };
    charts.into_iter().filter_map(warning).collect()
}

/// Returns true if a chart is in one tile, like those of UDIM layouts.
fn is_within_its_tile(chart: &UvChart<'_>, size: u32) -> bool {
    let size = f64::from(size);
    // Texels are whole.
    let overreach = OVERREACH * size + 1.0;
    let parts = chart.parts.iter().filter(|part| part.texels > 0);
    let ends = parts.flat_map(|part| {
        (0..2).map(move |axis| {
            let tile = f64::from(part.uv_tile[axis]) * size;
            let ends = [part.bounds[axis], part.bounds[axis + 2]];
            ends.map(|end| f64::from(end) - f64::from(part.texel_from_uv[axis]) - tile)
        })
    });
    ends.into_iter()
        .all(|[low, high]| low >= -overreach && high <= size + overreach)
}
