//! `sabi presets`: the presets of maps.

use std::path::PathBuf;

use sabi_engine::baking::preset_description::{
    PresetDescription, PresetDocument, PresetFileDescription, describe_preset,
};
use sabi_engine::baking::presets::{ListedPreset, default_preset_folder, export_presets, find_preset, preset_text};
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{PresetsArguments, PresetsCommand};
use crate::exit::{Exit, Failure};
use crate::printable::{Page, printable_lines};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &PresetsArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    match &arguments.command {
        PresetsCommand::List { json } => list(*json, terminal),
        PresetsCommand::Show { name, toml, json } => show(name, *toml, *json, terminal),
        PresetsCommand::Check { files } => check(files, terminal),
    }
}

/// A preset in the JSON of the list.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PresetListing {
    /// Name of the preset.
    name: String,
    /// File of a preset that the user wrote.
    file: Option<PathBuf>,
    /// Reason why its file cannot be used.
    fault: Option<String>,
    /// The preset, if it can be used.
    preset: Option<PresetDescription>,
}

fn list(json: bool, terminal: &Terminal) -> Result<Exit, Failure> {
    let folder = default_preset_folder();
    let found = export_presets(folder.as_deref());
    if json {
        let listed: Vec<PresetListing> = found.into_iter().map(listed).collect();
        terminal.json(&listed)?;
        return Ok(Exit::Done);
    }
    let width = found.iter().map(|listed| listed.name.len()).max().unwrap_or(0); // An empty list has no width.
    let line = |listed: &ListedPreset| match &listed.preset {
        Ok(preset) => format!("{:width$}  {}", listed.name, preset.about),
        Err(fault) => format!("{:width$}  {fault}", listed.name),
    };
    terminal.page(&found.iter().map(line).collect())?;
    if let Some(folder) = folder {
        terminal.note(format_args!("Presets of your own are read from {}", folder.display()));
    }
    Ok(Exit::Done)
}

fn listed(found: ListedPreset) -> PresetListing {
    let (preset, fault) = match found.preset {
        Ok(preset) => (Some(describe_preset(&preset)), None),
        Err(fault) => (None, Some(fault)),
    };
    PresetListing {
        name: found.name,
        file: found.file,
        fault,
        preset,
    }
}

fn show(name: &str, toml: bool, json: bool, terminal: &Terminal) -> Result<Exit, Failure> {
    let folder = default_preset_folder();
    if toml {
        terminal.data(&printable_lines(&preset_text(name, folder.as_deref())?))?;
        return Ok(Exit::Done);
    }
    let preset = describe_preset(&find_preset(name, folder.as_deref())?);
    if json {
        terminal.json(&preset)?;
    } else {
        terminal.page(&table(&preset))?;
    }
    Ok(Exit::Done)
}

/// Returns the name and sentence of a preset, then its files, one per line.
fn table(preset: &PresetDescription) -> Page {
    let way = match preset.normal_y {
        "-" => "downward, as DirectX has it",
        _ => "upward, as OpenGL has it",
    };
    let mut page = Page::default();
    page.line(&preset.name);
    page.lines(&preset.about);
    page.line("");
    page.line(format_args!("names    {}", preset.names));
    page.line(format_args!("normals  green means {way}"));
    page.line("");
    let documents = preset.documents.iter().map(document_row);
    let rows: Vec<[String; 4]> = preset.files.iter().map(row).chain(documents).collect();
    let widths = [0, 1, 2].map(|column| rows.iter().map(|row| row[column].len()).max().unwrap_or(0));
    for [map, format, packing, when] in &rows {
        let line = format!(
            "{map:a$}  {format:b$}  {packing:c$}  {when}",
            a = widths[0],
            b = widths[1],
            c = widths[2]
        );
        page.line(line.trim_end());
    }
    if !preset.left_out.is_empty() {
        page.line("");
        page.line(format_args!("left out  {}", preset.left_out.join(", ")));
    }
    page
}

fn row(file: &PresetFileDescription) -> [String; 4] {
    let map = file
        .map
        .clone()
        .unwrap_or_else(|| format!("({})", file.outputs.unwrap_or("outputs")));
    let color = if file.color_space == "srgb" { " sRGB" } else { "" };
    let size = file.size.as_ref().map_or(String::new(), |size| format!(" at {size}"));
    let normalized = if file.normalize { ", 0 to 1" } else { "" };
    let format = format!("{} {}{color}{size}{normalized}", file.ending, file.bits);
    [map, format, file.packing(), file.when.clone()]
}

fn document_row(document: &PresetDocument) -> [String; 4] {
    let name = "(model)".to_owned();
    [
        name,
        document.ending.to_owned(),
        document.about.to_owned(),
        String::new(),
    ]
}

fn check(files: &[PathBuf], terminal: &Terminal) -> Result<Exit, Failure> {
    let mut is_sound = true;
    for file in files {
        match find_preset(&file.to_string_lossy(), None) {
            Ok(preset) => terminal.data_line(format_args!("{}: {} files", file.display(), preset.maps.len()))?,
            Err(fault) => {
                is_sound = false;
                terminal.failure(&fault.into());
            }
        }
    }
    Ok(if is_sound { Exit::Done } else { Exit::BadInput })
}
