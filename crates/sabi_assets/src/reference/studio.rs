//! Specimens on their models: Sabi writes the textures, the scene shows them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use serde_json::Value;

use super::pages::pictures_of;
use super::picture::Texture;
use super::scene::{ReferenceLook, SIDE, render};
use super::specimen::{Specimen, specimen};
use crate::models::glb::Model;
use crate::models::model;
use crate::small_png::{encode, read};
use xtask::project::{Project, TaskError, create_folder, write_file};

/// Size limit of a picture of the reference.
pub(crate) const MOST_BYTES: usize = 24 * 1024;
/// Texels along a side of the textures: about two for each sample of the picture.
const TEXELS: &str = "1024";
/// Strokes on the crate that the specimen of the paint node names, drawn with the example `draw` of `sabi_paint`.
const STROKES: &[u8] = include_bytes!("specimen.paint/crate.strokes");
/// The maps that a material is shown with, as the presets call them.
const MAPS: [&str; 4] = ["base_color", "roughness", "metallic", "normal"];

/// Renderer of the pictures of nodes, with a folder for its temporary files.
pub(crate) struct Studio<'a> {
    project: &'a Project,
    sabi: &'a Path,
    /// Folder of temporary graphs and textures.
    work_folder: PathBuf,
    /// Models made so far.
    models: BTreeMap<String, Model>,
}

impl Studio<'_> {
    /// Creates an empty work folder in the target folder.
    pub(crate) fn open<'a>(project: &'a Project, sabi: &'a Path) -> Result<Studio<'a>, TaskError> {
        let work_folder = project.target.join("reference");
        // A folder that is not there yet needs no clearing.
        let _ = fs::remove_dir_all(&work_folder);
        create_folder(&work_folder)?;
        let strokes = work_folder.join("specimen.paint");
        create_folder(&strokes)?;
        write_file(&strokes.join("crate.strokes"), STROKES)?;
        Ok(Studio {
            project,
            sabi,
            work_folder,
            models: BTreeMap::new(),
        })
    }

    /// Draws all results of these nodes; a node that cannot be drawn is reported and gets no picture.
    pub(crate) fn shoot(&mut self, nodes: &[&Value], folder: &Path) -> Result<(), TaskError> {
        for node in nodes {
            for (output, name) in pictures_of(node) {
                let name_of_output = output["name"].as_str();
                let Some(specimen) = name_of_output.and_then(|output| specimen(node, output)) else {
                    continue;
                };
                let path = folder.join(&name);
                if let Some(parent) = path.parent() {
                    create_folder(parent)?;
                }
                match self.picture(&specimen) {
                    Ok(bytes) => {
                        eprintln!("{name}: {:.1} KiB", bytes.len() as f64 / 1024.0);
                        write_file(&path, bytes)?;
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
        let graph = self.work_folder.join("specimen.sabi");
        fs::write(&graph, format!("{:#}\n", specimen.graph)).map_err(|error| error.to_string())?;
        let looks: Result<Vec<ReferenceLook>, String> = model
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

    /// Runs a command of Sabi on a specimen; an error is its output.
    fn sabi(&self, command: &str, graph: &Path, mesh: &str, material: &str, rest: &[&str]) -> Result<(), String> {
        let mesh = format!("assets/meshes/{mesh}.glb");
        let output = self
            .project
            .command(self.sabi)
            .map_err(|stop| stop.sentence)?
            .arg(command)
            .arg(graph)
            .args(["--mesh", &mesh, "--size", TEXELS, "--material", material, "--quiet"])
            .args(rest)
            // The pictures show the project's own nodes only.
            .env("SABI_NODES", self.work_folder.join("no_nodes"))
            .stdout(Stdio::null())
            .output()
            .map_err(|error| error.to_string())?;
        if output.status.success() {
            Ok(())
        } else {
            Err(String::from_utf8_lossy(&output.stderr).trim().to_owned())
        }
    }

    fn preview(&self, graph: &Path, mesh: &str, material: &str, target: &str) -> Result<ReferenceLook, String> {
        let file = self.work_folder.join("preview.png");
        let path = file.display().to_string();
        self.sabi("preview", graph, mesh, material, &["--node", target, "-o", &path])?;
        read(&file).map(|picture| ReferenceLook::Flat(Texture(picture)))
    }

    fn bake(&self, graph: &Path, mesh: &str, material: &str) -> Result<ReferenceLook, String> {
        let folder = self.work_folder.join("bake");
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
            read(file).map(Texture)
        };
        let [base_color, roughness, metallic, normal] = MAPS.map(map);
        Ok(ReferenceLook::Lit {
            base_color: base_color?,
            roughness: roughness?,
            metallic: metallic?,
            normal: normal?,
        })
    }
}
