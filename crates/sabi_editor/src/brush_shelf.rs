//! Brushes that the artist keeps: one file each in the folder of the settings, and the pictures of brushes.
//!
//! A file of a brush has the line `sabi brush 1` and the brush as JSON on one line. If the brush has a picture, the
//! line `picture ENDING` and the bytes of the picture follow, so that a single file can be given to somebody else.

use std::path::{Path, PathBuf};

use sabi_engine::source::Strokes;
use sabi_files::write_whole;
use sabi_paint::{PictureName, Tip};

use crate::settings::brush::BrushChoices;

/// Ending of the files of brushes.
pub(crate) const ENDING: &str = "sabibrush";
/// First line of a file.
const TITLE: &[u8] = b"sabi brush 1";
/// Start of the line before the bytes of a picture.
const PICTURE: &[u8] = b"picture ";
/// Largest file of a brush that is read.
const LIMIT_BYTES: u64 = 300 << 20;
/// Brushes that come with the program, as a list of names and brushes. Settings that a brush does not list are the
/// defaults of its tip.
const OWN: &str = include_str!("../../../assets/brushes.json");

/// A brush that is kept.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeptBrush {
    pub(crate) name: String,
    pub(crate) brush: BrushChoices,
    /// File of the brush; `None` for a brush that comes with the program.
    pub(crate) file: Option<PathBuf>,
}

/// The brushes that are kept.
pub(crate) struct BrushShelf {
    /// Folder of the files; `None` on a system without a folder for settings.
    folder: Option<PathBuf>,
    /// Brushes that come with the program, and after them the artist's own by name.
    pub(crate) brushes: Vec<KeptBrush>,
}

/// A brush with the bytes and the ending of its picture.
type ReadBrush = (BrushChoices, Option<(Vec<u8>, String)>);

impl BrushShelf {
    /// The brushes beside the settings. A file that is no brush is left out; its error is shown if the user opens the
    /// file.
    pub(crate) fn open(settings: Option<&Path>) -> BrushShelf {
        let mut shelf = BrushShelf {
            folder: settings.map(|folder| folder.join("brushes")),
            brushes: Vec::new(),
        };
        shelf.read();
        shelf
    }

    fn read(&mut self) {
        self.brushes = own_brushes().unwrap_or_default(); // Never missing: it is part of the program, and tested.
        let entries = self.folder.as_ref().and_then(|folder| std::fs::read_dir(folder).ok());
        let mut files: Vec<PathBuf> = entries
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|file| file.extension().is_some_and(|ending| ending == ENDING))
            .collect();
        files.sort();
        for file in files {
            let name = file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            if let (Some(name), Ok((brush, _))) = (name, read_brush(&file)) {
                self.brushes.push(KeptBrush {
                    name,
                    brush,
                    file: Some(file),
                });
            }
        }
    }

    /// Keeps a brush under a name, with its picture.
    ///
    /// # Errors
    /// A sentence about why it is not kept.
    pub(crate) fn keep(&mut self, name: &str, brush: &BrushChoices, strokes: &Strokes) -> Result<(), String> {
        let folder = self
            .folder
            .clone()
            .ok_or("This system has no folder for settings, so that no brushes are kept.")?;
        let name = name.trim();
        let is_plain = |c: char| !c.is_control() && !"/\\:*?\"<>|.".contains(c);
        if name.is_empty() || !name.chars().all(is_plain) {
            return Err("The name of a brush is the name of a file: letters, digits, spaces and dashes.".to_owned());
        }
        let file = folder.join(format!("{name}.{ENDING}"));
        if file.exists() {
            return Err(format!(
                "There is a brush '{name}' already; choose another name, or remove it first."
            ));
        }
        create(&folder)?;
        write_brush(&file, brush, strokes)?;
        self.read();
        Ok(())
    }

    /// Takes a file of a brush from elsewhere, and returns the brush.
    ///
    /// # Errors
    /// A sentence about a file that is no brush.
    pub(crate) fn take(&mut self, file: &Path, strokes: &Strokes) -> Result<BrushChoices, String> {
        let brush = opened(file, strokes)?;
        let stem = file.file_stem().unwrap_or_default(); // Every file has a name.
        let name = stem.to_string_lossy().replace('.', " ");
        self.keep(&name, &brush, strokes)?;
        Ok(brush)
    }

    /// Removes a kept brush.
    ///
    /// # Errors
    /// A sentence about a file that cannot be removed.
    pub(crate) fn remove(&mut self, file: &Path) -> Result<(), String> {
        std::fs::remove_file(file).map_err(|error| format!("{} cannot be removed: {error}", file.display()))?;
        self.read();
        Ok(())
    }

    /// Keeps the picture of a brush, so that it can be used in other graphs.
    ///
    /// # Errors
    /// A sentence about why it is not kept.
    pub(crate) fn keep_picture(&self, name: &PictureName, strokes: &Strokes) -> Result<(), String> {
        let (Some(folder), Some(bytes)) = (&self.folder, strokes.picture_file(name)) else {
            return Ok(());
        };
        let folder = folder.join("pictures");
        create(&folder)?;
        write_whole(&folder.join(name.as_str()), &bytes).map_err(|error| error.to_string())
    }

    /// Hands a kept picture to the strokes of a document.
    ///
    /// # Errors
    /// A sentence about a picture that is not kept any more.
    pub(crate) fn find_picture(&self, name: &PictureName, strokes: &Strokes) -> Result<(), String> {
        let gone = || "The picture of the brush is gone; choose another one.".to_owned();
        let folder = self.folder.as_ref().ok_or_else(gone)?;
        let found = strokes
            .take_picture(&folder.join("pictures").join(name.as_str()))
            .map_err(|_| gone())?;
        if found == *name { Ok(()) } else { Err(gone()) }
    }
}

fn create(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{} cannot be created: {error}", folder.display()))
}

/// The brushes that come with the program.
fn own_brushes() -> serde_json::Result<Vec<KeptBrush>> {
    #[derive(serde::Deserialize)]
    struct OwnBrush {
        name: String,
        brush: serde_json::Map<String, serde_json::Value>,
    }
    let all: Vec<OwnBrush> = serde_json::from_str(OWN)?;
    let kept = all.into_iter().map(|own| {
        let tip: Tip = serde_json::from_value(own.brush["tip"].clone())?;
        let mut brush = serde_json::to_value(BrushChoices::default().with_tip(tip))?;
        if let Some(usual) = brush.as_object_mut() {
            usual.extend(own.brush);
        }
        Ok(KeptBrush {
            name: own.name,
            brush: serde_json::from_value(brush)?,
            file: None,
        })
    });
    kept.collect()
}

/// Opens the brush of a file, and adds its picture to the strokes of a document.
///
/// # Errors
/// A sentence about a file that is no brush.
pub(crate) fn opened(file: &Path, strokes: &Strokes) -> Result<BrushChoices, String> {
    let (brush, picture) = read_brush(file)?;
    let kept = picture
        .map(|(bytes, ending)| strokes.keep_picture(bytes, &ending))
        .transpose();
    let kept = kept.map_err(|why| format!("{}: {why}", file.display()))?;
    // Without its picture, or with another one, a brush would leave nothing.
    let picture = brush.picture.clone().filter(|tip| Some(&tip.picture) == kept.as_ref());
    Ok(BrushChoices { picture, ..brush })
}

fn read_brush(file: &Path) -> Result<ReadBrush, String> {
    let shown = file.display();
    let bytes = sabi_files::read_plain(file, LIMIT_BYTES).map_err(|_| format!("{shown} cannot be read as a brush"))?;
    let none = || format!("{shown} is no brush of Sabi, or of a newer version");
    let (title, rest) = line(&bytes).ok_or_else(none)?;
    let (json, rest) = line(rest).ok_or_else(none)?;
    if title != TITLE {
        return Err(none());
    }
    let brush: BrushChoices = serde_json::from_slice(json).map_err(|_| none())?;
    let picture = line(rest).and_then(|(head, bytes)| {
        let ending = std::str::from_utf8(head.strip_prefix(PICTURE)?).ok()?;
        Some((bytes.to_vec(), ending.to_owned()))
    });
    Ok((brush.sanitized(), picture))
}

/// The first line without its end, and what follows.
fn line(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|byte| *byte == b'\n')?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

fn write_brush(file: &Path, brush: &BrushChoices, strokes: &Strokes) -> Result<(), String> {
    let json = serde_json::to_vec(brush).map_err(|error| error.to_string())?;
    let mut bytes = [TITLE, &json].join(&b'\n');
    bytes.push(b'\n');
    if let Some(tip) = &brush.picture {
        let picture = strokes.picture_file(&tip.picture);
        let picture = picture.ok_or("The picture of the brush is gone; choose another one.")?;
        let ending = tip.picture.as_str().rsplit('.').next().unwrap_or("png"); // Every name has one.
        bytes.extend_from_slice(PICTURE);
        bytes.extend_from_slice(ending.as_bytes());
        bytes.push(b'\n');
        bytes.extend_from_slice(&picture);
    }
    write_whole(file, &bytes).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use sabi_paint::{PicturePart, PictureTip};

    use super::*;

    #[test]
    fn brushes_that_come_with_the_program_can_be_read_and_have_different_names() {
        let shelf = BrushShelf::open(None);
        assert!(shelf.brushes.len() >= 12, "{}", shelf.brushes.len());
        for kept in &shelf.brushes {
            assert_eq!(kept.brush, kept.brush.clone().sanitized(), "{}", kept.name);
            assert_eq!(shelf.brushes.iter().filter(|other| other.name == kept.name).count(), 1);
        }
    }

    #[test]
    fn a_kept_brush_is_found_again_and_can_be_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let strokes = Strokes::default();
        let mut shelf = BrushShelf::open(Some(folder.path()));
        let own = shelf.brushes.len();
        let brush = BrushChoices::default().with_tip(Tip::Chalk);
        shelf.keep(" Old wall ", &brush, &strokes).expect("kept");
        let found = BrushShelf::open(Some(folder.path()));
        let kept = found.brushes.last().expect("a brush");
        assert_eq!((kept.name.as_str(), &kept.brush), ("Old wall", &brush));
        shelf.remove(kept.file.as_deref().expect("a file")).expect("removed");
        assert_eq!(shelf.brushes.len(), own);
        assert!(shelf.keep("../up", &brush, &strokes).is_err());
    }

    #[test]
    fn the_file_of_a_brush_brings_its_picture_to_another_document() {
        let [here, there] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        let strokes = Strokes::default();
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pictures/army-paint.png");
        let picture = strokes.take_picture(&file).expect("a picture");
        let brush = BrushChoices::default().with_picture(PictureTip {
            picture: picture.clone(),
            part: PicturePart::Light,
        });
        let mut shelf = BrushShelf::open(Some(here.path()));
        shelf.keep("Stencil", &brush, &strokes).expect("kept");
        let file = here.path().join("brushes/Stencil.sabibrush");
        let elsewhere = Strokes::default();
        let taken = BrushShelf::open(Some(there.path()))
            .take(&file, &elsewhere)
            .expect("taken");
        assert_eq!(taken, brush);
        assert!(elsewhere.picture(&picture).is_some());
    }

    #[test]
    fn the_error_about_a_file_that_is_no_brush_names_the_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("odd.sabibrush");
        for bytes in [
            b"".as_slice(),
            b"sabi brush 2\n{}\n",
            b"sabi brush 1\nno json\n",
            b"sabi brush 1",
        ] {
            std::fs::write(&file, bytes).expect("written");
            let refused = opened(&file, &Strokes::default()).expect_err("no brush");
            assert!(refused.contains("odd.sabibrush"), "{refused}");
        }
    }
}
