//! Reads a document and checks everything that can be checked without the kinds.

mod body;
mod fields;

use std::collections::{BTreeMap, BTreeSet};

use body::{BodyContent, read_body};
use fields::Fields;

use crate::document::{Description, Fit, GroupDef, LibrarySource, Preview, SavedView};
use crate::file_error::ReadError;
use crate::format;
use crate::json::{Json, Tree};
use crate::name::check_name;
use crate::{Document, FileError};

impl Document {
    /// Reads a graph file of this or an earlier version.
    ///
    /// # Errors
    /// The first error in the file, with its line and column.
    pub fn from_json(text: &str) -> Result<Document, FileError> {
        read(text).map_err(|error| error.in_text(text))
    }
}

/// Returns the version of the file format that a graph file is written in.
///
/// # Errors
/// The text is not a graph, or has an unknown version.
pub fn format_version(text: &str) -> Result<u32, FileError> {
    let read = || crate::migrate::version_of(&crate::json::parse(text)?);
    read().map_err(|error: ReadError| error.in_text(text))
}

fn read(text: &str) -> Result<Document, ReadError> {
    let json = crate::migrate::to_newest(crate::json::parse(text)?)?;
    let mut fields = Fields::of(json, "the file", &format::DOCUMENT)?;
    // The migration checked these two keys already.
    fields.take("format");
    fields.take("version");
    let name = fields.text("name")?.unwrap_or_default(); // A document may have no name.
    let description = read_description(&mut fields)?;
    let preview = fields.take("preview").map(read_preview).transpose()?;
    let fit = fields.take("fit").map(read_fit).transpose()?.unwrap_or(Fit::Unit);
    let seed = fields.whole("seed")?.unwrap_or(0);
    let groups = fields.map("groups")?;
    let group_names: BTreeSet<String> = groups.iter().map(|member| member.key.clone()).collect();
    let BodyContent { graph, inputs, outputs } = read_body(&mut fields, &group_names)?;
    let mut document = Document {
        name,
        description,
        preview,
        fit,
        seed,
        graph,
        groups: BTreeMap::new(),
        inputs,
        outputs,
        extra: BTreeMap::new(),
    };
    for member in groups {
        check_name("group", &member.key, "").map_err(|problem| ReadError::new(member.key_at, problem))?;
        let group = read_group(member.value, &group_names).map_err(|error| error.in_group(&member.key))?;
        document.groups.insert(member.key, group);
    }
    document.extra = fields.extra()?;
    Ok(document)
}

fn read_group(json: Json, group_names: &BTreeSet<String>) -> Result<GroupDef, ReadError> {
    let mut fields = Fields::of(json, "groups", &format::GROUP)?;
    let name = fields.text("name")?;
    let description = read_description(&mut fields)?;
    let library = fields.take("library").map(read_library).transpose()?;
    let fit = fields.take("fit").map(read_fit).transpose()?;
    let BodyContent { graph, inputs, outputs } = read_body(&mut fields, group_names)?;
    Ok(GroupDef {
        name,
        description,
        library,
        fit,
        graph,
        inputs,
        outputs,
        extra: fields.extra()?,
    })
}

fn read_description(fields: &mut Fields) -> Result<Description, ReadError> {
    let about = fields.text("about")?;
    let words = fields.texts("words")?.into_iter().map(|(_, word)| word).collect();
    Ok(Description { about, words })
}

fn read_library(json: Json) -> Result<LibrarySource, ReadError> {
    let mut fields = Fields::of(json, "library", &format::LIBRARY)?;
    let mut text = |key: &str, advice| super::read::fields::text(fields.need(key, advice)?, key);
    Ok(LibrarySource {
        file: text("file", "a linked group has the file that it is a copy of")?,
        digest: text(
            "digest",
            "a linked group has the digest of the file that it is a copy of",
        )?,
        extra: fields.extra()?,
    })
}

fn read_preview(json: Json) -> Result<Preview, ReadError> {
    let mut fields = Fields::of(json, "preview", &format::PREVIEW)?;
    let names = |texts: Vec<(usize, String)>| texts.into_iter().map(|(_, name)| name).collect();
    Ok(Preview {
        mesh: fields.text("mesh")?,
        textures: fields.text("textures")?,
        parts: fields.texts("parts").map(names)?,
        without: fields.texts("without").map(names)?,
        turn_faces: fields.flag("turn_faces")?,
        size: fields.whole("size")?,
        variant: fields.text("variant")?,
        views: read_views(&mut fields)?,
        extra: fields.extra()?,
    })
}

fn read_views(fields: &mut Fields) -> Result<BTreeMap<String, SavedView>, ReadError> {
    let mut views = BTreeMap::new();
    for member in fields.map("views")? {
        check_name("view", &member.key, "").map_err(|problem| ReadError::new(member.key_at, problem))?;
        let mut fields = Fields::of(member.value, "views", &format::VIEW)?;
        let view = SavedView {
            target: fields.numbers("target", "a list of three numbers")?.unwrap_or([0.0; 3]),
            yaw: fields.number("yaw")?.unwrap_or(0.0),
            pitch: fields.number("pitch")?.unwrap_or(0.0),
            distance: fields.number("distance")?.unwrap_or(SavedView::FAR),
            is_parallel: fields.flag("parallel")?,
            extra: fields.extra()?,
        };
        views.insert(member.key, view);
    }
    Ok(views)
}

fn read_fit(json: Json) -> Result<Fit, ReadError> {
    match &json.tree {
        Tree::Text(word) if word == "unit" => Ok(Fit::Unit),
        Tree::Text(word) if word == "metres" => Ok(Fit::Metres),
        Tree::Text(word) if word == "piece" => Ok(Fit::Piece),
        Tree::Number(metres) if *metres > 0.0 => Ok(Fit::Length(*metres)),
        _ => Err(ReadError::expected(
            &json,
            "fit",
            "\"unit\", \"metres\", \"piece\", or the length above zero that counts as 1",
        )),
    }
}
