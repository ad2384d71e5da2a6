//! Choice of the surface that is unwrapped, and its unwrapping.

use std::collections::BTreeSet;

use sabi_surface::atlas::{Repeats, repeats};
use sabi_surface::model::{Model, ModelMaterial};
use sabi_surface::unwrap::{UnwrapError, unwrap_cached, unwrap_materials};

use super::{ModelOptions, Overlap, UnwrapResult};

/// Surface that is unwrapped.
pub(super) enum Unwrap {
    /// All of it, onto one sheet.
    All,
    /// Some materials, each unwrapped onto a sheet of its own.
    Materials(BTreeSet<u32>),
}

/// Returns the part of a model that has to be unwrapped: the requested part, otherwise parts without UVs (with a warning)
/// and parts that repeat too often (listed separately).
pub(super) fn unwrapping(model: &mut Model, options: &ModelOptions) -> (Option<Unwrap>, Vec<Repeats>) {
    let asked = without_uvs(model, options);
    if options.overlap != Overlap::Auto || matches!(asked, Some(Unwrap::All)) {
        return (asked, Vec::new());
    }
    let mut materials = match asked {
        Some(Unwrap::Materials(materials)) => materials,
        _ => BTreeSet::new(),
    };
    let mut repeats = repeats(&model.mesh, options.udim);
    repeats.retain(|repeats| !materials.contains(&repeats.material));
    materials.extend(repeats.iter().map(|repeats| repeats.material));
    ((!materials.is_empty()).then_some(Unwrap::Materials(materials)), repeats)
}

/// Returns the part of a model that has to be unwrapped: the requested part, otherwise parts without UVs, for which it adds a warning.
fn without_uvs(model: &mut Model, options: &ModelOptions) -> Option<Unwrap> {
    if options.overlap == Overlap::Unwrap {
        return Some(Unwrap::All);
    }
    if model.mesh.uvs.is_empty() {
        let sentence = "The model has no UVs, so it was unwrapped onto one sheet for all its materials.";
        model.warnings.push(sentence.to_owned());
        return Some(Unwrap::All);
    }
    let bare = &model.without_uvs;
    let labels: Vec<String> = bare
        .iter()
        .filter_map(|index| model.materials.get(*index as usize))
        .map(ModelMaterial::label)
        .collect();
    if bare.is_empty() {
        return None;
    }
    let (rest, what) = if bare.len() == model.materials.len() {
        let rest = "so all of it was unwrapped again onto one sheet for all its materials";
        (rest, Unwrap::All)
    } else {
        let rest = match bare.len() {
            1 => "so the surface of this material was unwrapped onto a sheet of its own; the rest keeps its UVs",
            _ => {
                "so the surfaces of these materials were unwrapped, each onto a sheet of its own; the rest keeps its UVs"
            }
        };
        (rest, Unwrap::Materials(bare.clone()))
    };
    let sentence = format!("A part of the model has no UVs ({}), {rest}.", first_of(&labels));
    model.warnings.push(sentence);
    Some(what)
}

/// Joins the first few names of a list, and the number of the others.
fn first_of(names: &[String]) -> String {
    const MOST_NAMED: usize = 4;
    let named = names[..names.len().min(MOST_NAMED)].join(", ");
    match names.len().saturating_sub(MOST_NAMED) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

/// Unwraps a model and replaces its mesh.
pub(super) fn unwrap_model(
    model: &mut Model,
    options: &ModelOptions,
    what: &Unwrap,
) -> Result<UnwrapResult, UnwrapError> {
    let folder = options.cache_folder();
    let (unwrapped, was_cached) = match what {
        Unwrap::All => unwrap_cached(folder.as_deref(), &model.mesh)?,
        Unwrap::Materials(materials) => unwrap_materials(folder.as_deref(), &model.mesh, materials)?,
    };
    model.mesh = unwrapped.mesh;
    model.warnings.extend(unwrapped.report.warnings.iter().cloned());
    let last = model.mesh.texture_uvs.last();
    let uv_set = match &mut model.origins {
        Some(origins) => {
            origins.follow(&unwrapped.source_vertex);
            let materials = match what {
                Unwrap::All => None,
                Unwrap::Materials(materials) => Some(materials),
            };
            origins.free_uv_set(&model.mesh, materials)
        }
        None => last.map_or(0, |last| last.set.saturating_add(1)),
    };
    Ok(UnwrapResult {
        uv_set,
        source_vertex: unwrapped.source_vertex,
        report: unwrapped.report,
        was_cached,
    })
}

#[cfg(test)]
mod tests {
    use super::first_of;

    #[test]
    fn a_long_list_of_names_is_shortened_and_counted() {
        let names: Vec<String> = ["a", "b", "c", "d", "e", "f"].map(str::to_owned).to_vec();
        assert_eq!(first_of(&names[..2]), "a, b");
        assert_eq!(first_of(&names[..4]), "a, b, c, d");
        assert_eq!(first_of(&names), "a, b, c, d and 2 more");
    }
}
