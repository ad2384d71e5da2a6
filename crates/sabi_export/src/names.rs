//! File names from the names of materials.

use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::model::{Model, ModelMaterial};

/// Longest stem of a file name, bytes: leaves room for suffixes within the 255 that file systems allow.
const LONGEST_STEM: usize = 120;

/// Converts a name to one that every file system accepts: no separators, control or wildcard characters, no dots or spaces at its ends, no
/// name that Windows keeps for devices, not too long. Empty when nothing is left.
pub fn file_stem(name: &str) -> String {
    let mut stem: String = name
        .trim()
        .chars()
        .map(|letter| match letter {
            '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => '_',
            letter if letter.is_control() => '_',
            letter => letter,
        })
        .collect();
    if is_device(&stem) {
        stem.insert(0, '_');
    }
    // A leading dot would hide the file.
    if stem.trim_end_matches(is_loose_end).is_empty() {
        return String::new();
    }
    let dots = stem.len() - stem.trim_start_matches('.').len();
    stem.replace_range(..dots, if dots > 0 { "_" } else { "" });
    let mut end = stem.len().min(LONGEST_STEM);
    while !stem.is_char_boundary(end) {
        end -= 1;
    }
    stem.truncate(end);
    stem.truncate(stem.trim_end_matches(is_loose_end).len());
    stem
}

/// Returns whether Windows silently drops a letter from the end of a name.
fn is_loose_end(letter: char) -> bool {
    letter == '.' || letter.is_whitespace()
}

/// Returns true if Windows would open a device instead of a file; the text after the first dot does not matter.
fn is_device(stem: &str) -> bool {
    let first = stem
        .split('.')
        .next()
        // A split has at least one part.
        .unwrap_or_default()
        .trim_end()
        .to_ascii_uppercase();
    let numbered = |prefix: &str| {
        first
            .strip_prefix(prefix)
            .is_some_and(|rest| rest.len() == 1 && rest.chars().all(|digit| digit.is_ascii_digit()))
    };
    matches!(first.as_str(), "CON" | "PRN" | "AUX" | "NUL") || numbered("COM") || numbered("LPT")
}

/// File name stem of each sheet of the model: one for each material, or a single one, like that of an unnamed material,
/// if all materials share a sheet.
pub fn sheet_names(model: &Model) -> Vec<String> {
    if !model.mesh.is_one_sheet {
        return set_names(model);
    }
    set_names(&Model {
        stem: model.stem.clone(),
        materials: vec![ModelMaterial::default()],
        ..Model::default()
    })
}

/// File name stem of each material of the model. All of them differ, even on systems that ignore upper and lower case.
/// A single unnamed material has the name of the model file; an unnamed one among several has that name and its number.
pub fn set_names(model: &Model) -> Vec<String> {
    let model_stem = match file_stem(&model.stem) {
        stem if stem.is_empty() => "model".to_owned(),
        stem => stem,
    };
    let lone = model.materials.len() == 1;
    let wanted: Vec<String> = model
        .materials
        .iter()
        .enumerate()
        .map(|(index, material)| match file_stem(&material.name) {
            stem if !stem.is_empty() => stem,
            _ if lone => model_stem.clone(),
            _ => format!("{model_stem}_{}", index + 1),
        })
        .collect();
    // Names from the file are kept if possible, so appending a number must not give one of them.
    let given: BTreeSet<String> = wanted.iter().map(|name| name.to_lowercase()).collect();
    let mut used = BTreeSet::new();
    // Number to try first for each name, since lower ones are taken.
    let mut next: BTreeMap<String, u32> = BTreeMap::new();
    wanted
        .into_iter()
        .map(|name| {
            if used.insert(name.to_lowercase()) {
                return name;
            }
            let number = next.entry(name.to_lowercase()).or_insert(2);
            loop {
                let numbered = format!("{name}_{number}");
                *number += 1;
                let key = numbered.to_lowercase();
                if !given.contains(&key) && used.insert(key) {
                    return numbered;
                }
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sabi_surface::model::ModelMaterial;

    use super::*;

    fn names(stem: &str, materials: &[&str]) -> Vec<String> {
        let material = |name: &&str| ModelMaterial {
            name: (*name).to_owned(),
            ..ModelMaterial::default()
        };
        set_names(&Model {
            stem: stem.into(),
            materials: materials.iter().map(material).collect(),
            ..Model::default()
        })
    }

    #[test]
    fn names_are_made_fit_for_every_file_system() {
        let cases = [
            ("Leather Strap", "Leather Strap"),
            ("Material.001", "Material.001"),
            ("a/b\\c:d*e?f\"g<h>i|j", "a_b_c_d_e_f_g_h_i_j"),
            ("../../etc/passwd", "__.._etc_passwd"),
            ("..", ""),
            ("  .hidden. ", "_hidden"),
            ("con", "_con"),
            ("LPT1.old", "_LPT1.old"),
            ("comet", "comet"),
            ("錆", "錆"),
            ("tab\tand\0zero", "tab_and_zero"),
        ];
        for (name, stem) in cases {
            assert_eq!(file_stem(name), stem, "{name:?}");
        }
        assert_eq!(file_stem(&"é".repeat(300)), "é".repeat(60));
    }

    #[test]
    fn a_lone_unnamed_material_takes_the_name_of_the_model() {
        assert_eq!(names("bench", &[""]), ["bench"]);
        assert_eq!(names("", &[""]), ["model"]);
        assert_eq!(names("bench", &["Wood"]), ["Wood"]);
        assert_eq!(names("bench", &["Wood", ""]), ["Wood", "bench_2"]);
    }

    #[test]
    fn names_are_unique_without_regard_to_case() {
        assert_eq!(
            names("m", &["wood", "Wood", "wood_2", "a/b", "a:b"]),
            ["wood", "Wood_3", "wood_2", "a_b", "a_b_2"]
        );
    }

    #[test]
    fn a_hundred_thousand_materials_of_one_name_have_names_of_their_own() {
        let all = names("m", &["wood"; 100_000]);
        assert_eq!((&*all[0], &*all[99_999]), ("wood", "wood_100000"));
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
    }

    proptest! {
        #[test]
        fn no_name_escapes_its_folder(name in ".*") {
            let stem = file_stem(&name);
            prop_assert!(stem.len() <= LONGEST_STEM);
            prop_assert!(!stem.contains(['/', '\\', '\0']) && !stem.starts_with('.'));
            prop_assert_eq!(file_stem(&stem), stem.clone());
        }
    }
}
