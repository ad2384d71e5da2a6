//! Material libraries (`.mtl`), as far as they go with metallic-roughness.

use std::collections::{BTreeMap, BTreeSet};

use super::statements::{MOST_LIBRARIES, logical_lines, split_word};
use crate::load::gltf::Resolve;
use crate::load::pictures::Pictures;
use crate::load::text::decoded;
use crate::load::warnings::Warnings;
use crate::model::{ModelMaterial, TextureRef, Wrap};

/// Materials by name, and the pictures that they name.
#[derive(Default)]
pub(super) struct Library {
    materials: Vec<ModelMaterial>,
    places: BTreeMap<String, usize>,
    /// Names of libraries that were looked for.
    known: BTreeSet<String>,
    pub(super) pictures: Pictures,
}

impl Library {
    /// Index of a material by its name.
    pub(super) fn place(&self, name: &str) -> Option<usize> {
        self.places.get(name).copied()
    }

    /// A copy of a material.
    pub(super) fn take(&self, name: &str) -> Option<ModelMaterial> {
        self.place(name).map(|place| self.materials[place].clone())
    }

    /// Reads the libraries of one `mtllib` statement: a name that may have spaces, or several names.
    pub(super) fn read(&mut self, names: &str, resolve: &mut Resolve, warnings: &mut Warnings) {
        if !self.is_next(names, warnings) {
            return;
        }
        let whole = resolve(names);
        // A space in a name may be escaped with a backslash.
        let escaped = names.replace("\\ ", "\0");
        let all: Vec<String> = escaped
            .split_ascii_whitespace()
            .map(|name| name.replace('\0', " "))
            .collect();
        match whole {
            Ok(bytes) => self.parse(&bytes, warnings),
            Err(reason) if all.len() < 2 => {
                warnings.add(format!("The material library {names} cannot be read: {reason}."));
            }
            Err(_) => {
                for name in all {
                    if !self.is_next(&name, warnings) {
                        continue;
                    }
                    match resolve(&name) {
                        Ok(bytes) => self.parse(&bytes, warnings),
                        Err(reason) => warnings.add(format!("The material library {name} cannot be read: {reason}.")),
                    }
                }
            }
        }
    }

    /// Returns whether a library is to be read: it was not looked for before, and there are not too many.
    fn is_next(&mut self, name: &str, warnings: &mut Warnings) -> bool {
        if self.known.contains(name) {
            return false;
        }
        if self.known.len() == MOST_LIBRARIES {
            warnings.add(format!(
                "The file names more than {MOST_LIBRARIES} material libraries; the others are left out."
            ));
            return false;
        }
        self.known.insert(name.to_owned())
    }

    fn parse(&mut self, bytes: &[u8], warnings: &mut Warnings) {
        let text = decoded(bytes);
        let mut current = None;
        for (_, line) in logical_lines(&text) {
            let (keyword, rest) = split_word(&line);
            if keyword == "newmtl" {
                // The first of two materials of one name stays.
                current = (!self.places.contains_key(rest)).then_some(self.materials.len());
                if let Some(place) = current {
                    self.places.insert(rest.to_string(), place);
                    self.materials.push(ModelMaterial {
                        name: rest.to_string(),
                        ..ModelMaterial::plain()
                    });
                }
            } else if let Some(place) = current {
                self.statement(place, keyword, rest, warnings);
            }
        }
    }

    fn statement(&mut self, place: usize, keyword: &str, rest: &str, warnings: &mut Warnings) {
        let picture = match keyword {
            "map_Kd" | "map_Ke" | "map_Pr" | "map_Pm" => self.picture(rest),
            _ => None,
        };
        let material = &mut self.materials[place];
        let number = || {
            rest.split_ascii_whitespace()
                .next()?
                .parse::<f32>()
                .ok()
                .filter(|x| x.is_finite())
        };
        match keyword {
            // A texture replaces the color, as in the programs that write these files.
            "map_Kd" if picture.is_some() => {
                material.base_color = picture;
                material.base_color_factor = [1.0, 1.0, 1.0, material.base_color_factor[3]];
            }
            "map_Ke" if picture.is_some() => {
                material.emission = picture;
                material.emission_factor = [1.0; 3];
            }
            "map_Pr" if picture.is_some() => {
                material.roughness = picture;
                material.roughness_factor = 1.0;
            }
            "map_Pm" if picture.is_some() => {
                material.metallic = picture;
                material.metallic_factor = 1.0;
            }
            "Kd" if material.base_color.is_none() => {
                if let Some([r, g, b]) = color(rest) {
                    material.base_color_factor = [r, g, b, material.base_color_factor[3]];
                }
            }
            "Ke" if material.emission.is_none() => {
                if let Some(emission) = color(rest) {
                    material.emission_factor = emission;
                }
            }
            "d" => material.base_color_factor[3] = number().map_or(1.0, |d| d.clamp(0.0, 1.0)),
            "Tr" => material.base_color_factor[3] = number().map_or(1.0, |tr| 1.0 - tr.clamp(0.0, 1.0)),
            "Pr" if material.roughness.is_none() => {
                material.roughness_factor = number().map_or(1.0, |pr| pr.clamp(0.0, 1.0))
            }
            "Pm" if material.metallic.is_none() => {
                material.metallic_factor = number().map_or(0.0, |pm| pm.clamp(0.0, 1.0))
            }
            "map_Bump" | "map_bump" | "bump" | "norm" | "map_d" => {
                warnings.add(format!(
                    "`{keyword}` of material `{}` is left out; glTF carries such maps.",
                    material.name
                ));
            }
            _ => {}
        }
    }

    /// Returns the texture use of a `map_…` statement, whose options precede the path.
    fn picture(&mut self, rest: &str) -> Option<TextureRef> {
        let (path, wrap) = map_path(rest);
        if path.is_empty() {
            return None;
        }
        Some(TextureRef {
            wrap: [wrap; 2],
            ..TextureRef::of(self.pictures.beside(path))
        })
    }
}

/// Parses a color of one to three finite numbers; a single number is a gray.
fn color(rest: &str) -> Option<[f32; 3]> {
    let values: Vec<f32> = rest
        .split_ascii_whitespace()
        .map_while(|word| word.parse().ok())
        .collect();
    match values[..] {
        [gray] if gray.is_finite() => Some([gray; 3]),
        [r, g, b, ..] if [r, g, b].iter().all(|x| x.is_finite()) => Some([r, g, b]),
        _ => None,
    }
}

/// The path behind the options of a `map_…`, and whether the picture tiles.
fn map_path(mut rest: &str) -> (&str, Wrap) {
    let mut wrap = Wrap::Repeat;
    while rest.starts_with('-') {
        let (option, mut tail) = split_word(rest);
        let most = match option {
            "-o" | "-s" | "-t" => 3,
            "-mm" => 2,
            "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-texres" | "-bm" | "-boost" | "-type"
            | "-colorspace" => 1,
            // No option: a file whose name begins with a dash.
            _ => break,
        };
        for taken in 0..most {
            let (word, after) = split_word(tail);
            // The numbers of -o, -s and -t may be fewer.
            if taken > 0 && word.parse::<f32>().is_err() {
                break;
            }
            if option == "-clamp" && word == "on" {
                wrap = Wrap::Clamp;
            }
            tail = after;
        }
        rest = tail;
    }
    (rest, wrap)
}
