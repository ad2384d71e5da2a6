//! Specimens on their models: Sabi writes the textures, the scene shows them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use serde_json::Value;

use super::pages::pictures_of;
use super::picture::Texture;
use super::scene::{Look, SIDE, render};
use super::specimen::{Specimen, specimen};
use crate::assets::glb::Model;
use crate::assets::model;
use crate::place::{Place, Stop};
use crate::small_png::encode;

/// No picture of the reference takes more.
pub(crate) const MOST_BYTES: usize = 24 * 1024;
/// Texels along a side of the textures: about two for each sample of the picture.
const TEXELS: &str = "1024";
/// The maps that a material is shown with, as the presets call them.
const MAPS: [&str; 4] = ["base_color", "roughness", "metallic", "normal"];

/// Where pictures are made.
pub(crate) struct Studio<'a> {
    place: &'a Place,
    sabi: &'a Path,
    /// For graphs and textures on the way.
    desk: PathBuf,
    /// Models made so far.
    models: BTreeMap<String, Model>,
}

impl Studio<'_> {
    /// Clears its desk in the target folder.
    pub(crate) fn open<'a>(place: &'a Place, sabi: &'a Path) -> Result<Studio<'a>, Stop> {
        let desk = place.target.join("reference");
        // A folder that is not there yet needs no clearing.
        let _ = fs::remove_dir_all(&desk);
        fs::create_dir_all(&desk)
            .map_err(|error| Stop::new(1, format!("The folder {} cannot be made: {error}.", desk.display())))?;
        Ok(Studio {
            place,
            sabi,
            desk,
            models: BTreeMap::new(),
        })
    }

    /// Takes the pictures of all results of these nodes; a node that cannot be shown is told and left without.
    pub(crate) fn shoot(&mut self, nodes: &[&Value], folder: &Path) -> Result<(), Stop> {
        for node in nodes {
            for (output, name) in pictures_of(node) {
                let name_of_output = output["name"].as_str();
                let Some(specimen) = name_of_output.and_then(|output| specimen(node, output)) else {
                    continue;
                };
                let path = folder.join(&name);
                if let Some(parent) = path.parent() {
                    fs::create_dir_all(parent)
                        .map_err(|error| Stop::new(1, format!("{} cannot be made: {error}.", parent.display())))?;
                }
                match self.picture(&specimen) {
                    Ok(bytes) => {
                        eprintln!("{name}: {:.1} KiB", bytes.len() as f64 / 1024.0);
                        fs::write(&path, bytes)
                            .map_err(|error| Stop::new(1, format!("{} cannot be written: {error}.", path.display())))?;
                    }
                    Err(why) => eprintln!("{name}: no picture. {why}"),
                }
            }
        }
        Ok(())
    }

    fn picture(&mut self, specimen: &Specimen) -> Result<Vec<u8>, String> {
        if !self.models.contains_key(&specimen.mesh) {
            let made = model(&specimen.mesh).ok_or_else(|| format!("There is no model {}.", specimen.mesh))?;
            self.models.insert(specimen.mesh.clone(), made);
        }
        let model = &self.models[&specimen.mesh];
        let graph = self.desk.join("specimen.sabi");
        fs::write(&graph, format!("{:#}\n", specimen.graph)).map_err(|error| error.to_string())?;
        let looks: Result<Vec<Look>, String> = model
            .materials
            .iter()
            .map(|material| {
                if specimen.is_material {
                    self.bake(&graph, &specimen.mesh, material.name)
                } else {
                    self.preview(&graph, &specimen.mesh, material.name, &specimen.target)
                }
            })
            .collect();
        encode(&render(model, &looks?), [SIDE; 2], MOST_BYTES)
    }

    /// Runs Sabi on a specimen; its own words come back when it fails.
    fn sabi(&self, command: &str, graph: &Path, mesh: &str, material: &str, rest: &[&str]) -> Result<(), String> {
        let mesh = format!("assets/meshes/{mesh}.glb");
        let output = self
            .place
            .command(self.sabi)
            .map_err(|stop| stop.sentence)?
            .arg(command)
            .arg(graph)
            .args(["--mesh", &mesh, "--size", TEXELS, "--material", material, "--quiet"])
            .args(rest)
            // Nobody's own nodes belong into the project's pictures.
            .env("SABI_NODES", self.desk.join("no_nodes"))
            .stdout(Stdio::null())
            .output()
            .map_err(|error| error.to_string())?;
        if output.status.success() {
            Ok(())
        } else {
            Err(String::from_utf8_lossy(&output.stderr).trim().to_owned())
        }
    }

    fn preview(&self, graph: &Path, mesh: &str, material: &str, target: &str) -> Result<Look, String> {
        let file = self.desk.join("preview.png");
        let path = file.display().to_string();
        self.sabi("preview", graph, mesh, material, &["--node", target, "-o", &path])?;
        Texture::read(&file).map(Look::Flat)
    }

    fn bake(&self, graph: &Path, mesh: &str, material: &str) -> Result<Look, String> {
        let folder = self.desk.join("bake");
        let _ = fs::remove_dir_all(&folder);
        let path = folder.display().to_string();
        self.sabi("bake", graph, mesh, material, &["-o", &path, "--all-maps"])?;
        let files: Vec<PathBuf> = fs::read_dir(&folder)
            .map_err(|error| error.to_string())?
            .flatten()
            .map(|entry| entry.path())
            .collect();
        let map = |name: &str| {
            let ending = format!("{name}.png");
            let is_it = |file: &&PathBuf| file.to_string_lossy().ends_with(&ending);
            let file = files
                .iter()
                .find(is_it)
                .ok_or_else(|| format!("The bake has no file that ends with {ending}."))?;
            Texture::read(file)
        };
        let [base_color, roughness, metallic, normal] = MAPS.map(map);
        Ok(Look::Lit {
            base_color: base_color?,
            roughness: roughness?,
            metallic: metallic?,
            normal: normal?,
        })
    }
}
