//! Reading of preset files.

use serde::Deserialize;

use super::component::{channel, components};
use super::{Component, ComponentSource, DocumentFormat, Map, MapContent, MapFormat, MapSize, NormalY, Preset, When};
use crate::name_pattern::NamePattern;
use crate::names::file_stem;
use crate::{Channel, OutputKind};

/// Version of the file format that is read.
const VERSION: u32 = 1;
/// Most maps of a preset.
const MOST_MAPS: usize = 256;
/// Limits of a side of a map, pixels.
const SIDES: std::ops::RangeInclusive<u32> = 1..=16_384;
/// Largest divisor of a map's size.
const MOST_DIVIDED: u32 = 64;

/// Fault of a preset file, as a sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the preset {file} cannot be used: {why}")]
pub struct PresetError {
    /// Name of the file.
    pub file: String,
    /// Fault and remedy.
    pub why: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PresetFile {
    version: u32,
    name: String,
    about: String,
    #[serde(default)]
    normal_y: NormalText,
    names: Option<String>,
    #[serde(default)]
    documents: Vec<DocumentFormat>,
    #[serde(default)]
    map: Vec<MapEntry>,
}

#[derive(Default, Deserialize)]
enum NormalText {
    #[default]
    #[serde(rename = "+")]
    Up,
    #[serde(rename = "-")]
    Down,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MapEntry {
    name: Option<String>,
    outputs: Option<OutputsText>,
    gray: Option<ComponentText>,
    rgb: Option<ComponentText>,
    r: Option<ComponentText>,
    g: Option<ComponentText>,
    b: Option<ComponentText>,
    a: Option<ComponentText>,
    format: FormatText,
    #[serde(default)]
    srgb: bool,
    #[serde(default)]
    dither: bool,
    #[serde(default)]
    normalize: bool,
    size: Option<SizeText>,
    when: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum OutputsText {
    Masks,
    Colors,
    Vectors,
}

impl OutputsText {
    fn kind(&self) -> OutputKind {
        match self {
            OutputsText::Masks => OutputKind::Mask,
            OutputsText::Colors => OutputKind::Color,
            OutputsText::Vectors => OutputKind::Vector,
        }
    }
}

/// A number everywhere, or the name of a channel.
#[derive(Deserialize)]
#[serde(untagged)]
enum ComponentText {
    Number(f32),
    Text(String),
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum FormatText {
    Png8,
    Png16,
    Tga,
    Exr16,
    Exr32,
}

/// Pixels of both sides, or text such as `1/2` and `2048x1024`.
#[derive(Deserialize)]
#[serde(untagged)]
enum SizeText {
    Number(u32),
    Text(String),
}

pub(super) fn parse(file: &str, text: &str) -> Result<Preset, PresetError> {
    let fault = |why: String| PresetError {
        file: file.to_owned(),
        why,
    };
    let read: PresetFile = toml::from_str(text).map_err(|error| fault(error.to_string().trim_end().to_owned()))?;
    preset(read).map_err(fault)
}

fn preset(read: PresetFile) -> Result<Preset, String> {
    if read.version != VERSION {
        return Err(format!(
            "it has version {}, and version {VERSION} is read here",
            read.version
        ));
    }
    if read.name.is_empty() || file_stem(&read.name) != read.name {
        return Err(format!("`{}` is no name; use letters, digits, '_' and '-'", read.name));
    }
    if read.map.is_empty() {
        return Err("it has no maps; add one as [[map]]".to_owned());
    }
    if read.map.len() > MOST_MAPS {
        return Err(format!(
            "it has {} maps, and at most {MOST_MAPS} are taken",
            read.map.len()
        ));
    }
    let names = read.names.unwrap_or_else(|| NamePattern::DEFAULT.to_owned());
    let words = NamePattern::WORDS.map(|word| (word, Some(word)));
    NamePattern::parse(&names, &words).map_err(|error| error.to_string())?;
    let maps = read.map.into_iter().enumerate().map(|(index, entry)| {
        let label = match &entry.name {
            Some(name) => format!("map `{name}`"),
            None => format!("map {}", index + 1),
        };
        map(entry).map_err(|why| format!("{label}: {why}"))
    });
    let maps: Vec<Map> = maps.collect::<Result<_, String>>()?;
    if let Some((name, format)) = twice(&maps) {
        return Err(format!(
            "two of its maps are `{name}` as .{format}; give one of them another name"
        ));
    }
    let normal_y = match read.normal_y {
        NormalText::Up => NormalY::Up,
        NormalText::Down => NormalY::Down,
    };
    Ok(Preset {
        name: read.name,
        about: read.about,
        normal_y,
        names,
        maps,
        documents: documents(read.documents, normal_y)?,
    })
}

/// Checks the documents of a preset with this direction of green.
fn documents(documents: Vec<DocumentFormat>, normal_y: NormalY) -> Result<Vec<DocumentFormat>, String> {
    if !documents.is_empty() && normal_y == NormalY::Down {
        return Err(
            "its documents are read with green upward; set `normal_y` to \"+\", or leave `documents` out and put them \
             into a preset of their own"
                .to_owned(),
        );
    }
    let twice = documents
        .iter()
        .enumerate()
        .find(|(at, document)| documents[..*at].contains(document));
    match twice {
        Some((_, document)) => Err(format!("`documents` has `{}` twice; name it once", document.name())),
        None => Ok(documents),
    }
}

/// Returns a map of the same file as another one.
fn twice(maps: &[Map]) -> Option<(&str, &'static str)> {
    let key = |map: &Map| {
        (
            map.name.to_lowercase(),
            map.format.ending(),
            match map.content {
                MapContent::Every(kind) => Some(kind),
                MapContent::Packed(_) => None,
            },
        )
    };
    let later = maps.iter().enumerate().find(|(index, map)| {
        let mut earlier = maps[..*index].iter();
        earlier.any(|other| key(other) == key(map))
    });
    later.map(|(_, map)| (map.name.as_str(), map.format.ending()))
}

fn map(entry: MapEntry) -> Result<Map, String> {
    let content = match &entry.outputs {
        Some(_) if has_components(&entry) => {
            return Err("it packs outputs and names components as well; leave one of both out".to_owned());
        }
        Some(outputs) => MapContent::Every(outputs.kind()),
        None => MapContent::Packed(packed(&entry)?),
    };
    let name = match (entry.name, &content) {
        (None, MapContent::Every(_)) => String::new(),
        (Some(_), MapContent::Every(_)) => {
            return Err("its files have the names of the outputs; leave `name` out".to_owned());
        }
        (None, MapContent::Packed(_)) => return Err("it has no `name`, which file names need".to_owned()),
        (Some(name), MapContent::Packed(_)) if name.is_empty() || file_stem(&name) != name => {
            return Err(format!(
                "`{name}` is no part of a file name; use letters, digits, '_' and '-'"
            ));
        }
        (Some(name), MapContent::Packed(_)) => name,
    };
    let format = match entry.format {
        FormatText::Png8 => MapFormat::Png { bits: 8 },
        FormatText::Png16 => MapFormat::Png { bits: 16 },
        FormatText::Tga => MapFormat::Tga,
        FormatText::Exr16 => MapFormat::ExrHalf,
        FormatText::Exr32 => MapFormat::Exr,
    };
    if entry.srgb && !format.is_whole() {
        return Err("OpenEXR files are linear; leave `srgb` out".to_owned());
    }
    if matches!((&content, format), (MapContent::Packed(components), MapFormat::Tga) if components.len() == 2) {
        return Err("TGA files have one, three or four components".to_owned());
    }
    if entry.normalize && !is_of_one_range(&content) {
        return Err(
            "`normalize` is for the height or the emission of a material, alone in its file; leave it out".to_owned(),
        );
    }
    Ok(Map {
        name,
        content,
        format,
        is_srgb: entry.srgb,
        is_dithered: entry.dither,
        is_normalized: entry.normalize,
        size: entry.size.map_or(Ok(MapSize::Divided(1)), size)?,
        when: entry.when.map_or(Ok(When::Varies), |text| when(&text))?,
    })
}

/// Returns true for files of a channel that may exceed 0 to 1, alone and as it is.
fn is_of_one_range(content: &MapContent) -> bool {
    let MapContent::Packed(components) = content else {
        return false;
    };
    let first = components.first().map(|component| &component.source);
    let Some(ComponentSource::Channel(channel @ (Channel::Height | Channel::Emission), _)) = first else {
        return false;
    };
    let is_same = |component: &Component| {
        matches!(&component.source, ComponentSource::Channel(other, _) if other == channel) && !component.is_inverted
    };
    components.iter().all(is_same)
}

fn has_components(entry: &MapEntry) -> bool {
    let keys = [&entry.gray, &entry.rgb, &entry.r, &entry.g, &entry.b, &entry.a];
    keys.into_iter().any(Option::is_some)
}

/// The components of a map, in the order of the file.
fn packed(entry: &MapEntry) -> Result<Vec<Component>, String> {
    let of = |text: &ComponentText, count| match text {
        ComponentText::Text(text) => components(text, count),
        ComponentText::Number(value) if (0.0..=1.0).contains(value) => Ok(vec![
            Component {
                source: ComponentSource::Constant(*value),
                is_inverted: false,
            };
            count
        ]),
        ComponentText::Number(value) => Err(format!("{value} is no value of a map; give 0 to 1")),
    };
    let mut found = match (&entry.gray, &entry.rgb, [&entry.r, &entry.g, &entry.b]) {
        (Some(gray), None, [None, None, None]) => of(gray, 1)?,
        (None, Some(rgb), [None, None, None]) => of(rgb, 3)?,
        (None, None, [Some(r), Some(g), Some(b)]) => [of(r, 1)?, of(g, 1)?, of(b, 1)?].concat(),
        _ => return Err("name its components as `gray`, as `rgb`, or as `r`, `g` and `b`; `a` may follow".to_owned()),
    };
    if let Some(alpha) = &entry.a {
        found.extend(of(alpha, 1)?);
    }
    Ok(found)
}

fn size(text: SizeText) -> Result<MapSize, String> {
    let fault = |text: &str| {
        format!("`{text}` is no size; give 1/2 (of the other maps), 1024, or 2048x1024 (pixels, 1 to 16384)")
    };
    let side = |text: &str| text.trim().parse::<u32>().ok().filter(|side| SIDES.contains(side));
    let text = match text {
        SizeText::Number(pixels) if SIDES.contains(&pixels) => return Ok(MapSize::Fixed([pixels; 2])),
        SizeText::Number(pixels) => pixels.to_string(),
        SizeText::Text(text) => text,
    };
    let divided = text.strip_prefix("1/").and_then(|by| by.parse::<u32>().ok());
    if let Some(by) = divided.filter(|by| (1..=MOST_DIVIDED).contains(by)) {
        return Ok(MapSize::Divided(by));
    }
    let pixels = match text.split_once('x') {
        Some((width, height)) => side(width).zip(side(height)),
        None => side(&text).map(|side| (side, side)),
    };
    let (width, height) = pixels.ok_or_else(|| fault(&text))?;
    Ok(MapSize::Fixed([width, height]))
}

fn when(text: &str) -> Result<When, String> {
    let argument = |word: &str| {
        let rest = text.strip_prefix(word)?.strip_prefix('(')?.strip_suffix(')')?;
        Some(channel(rest.trim()))
    };
    match text {
        "varies" => Ok(When::Varies),
        "always" => Ok(When::Always),
        "above_one" => Ok(When::ItselfAboveOne),
        _ => match (argument("connected"), argument("above_one")) {
            (Some(channel), _) => Ok(When::Connected(channel?)),
            (_, Some(channel)) => Ok(When::AboveOne(channel?)),
            (None, None) => Err(format!(
                "`{text}` is no condition; there is: varies, always, connected(CHANNEL), above_one, above_one(CHANNEL)"
            )),
        },
    }
}
