//! Files of bake plans: one item a line, as JSON.

use std::fs::{self, File};
use std::io::Read as _;
use std::path::Path;

use sabi_engine::opening::unread::{kind_of_unread, why_unread};
use sabi_engine::{EngineError, ErrorKind};
use sabi_files::{PathBase, canonical, io_reason, read_plain, write_whole};

use crate::item::BakeItem;

/// Maximum size. Larger files are refused before they are read.
const SIZE_LIMIT_BYTES: u64 = 1 << 30;

/// First bytes of a plan.
const START: &[u8] = b"{\"item\":0,\"key\":";

/// Bakes that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct BakePlan {
    /// Absolute folder of its file.
    pub base: PathBase,
    /// The bakes. The number of a bake is its index.
    pub items: Vec<BakeItem>,
}

impl BakePlan {
    /// Reads a plan.
    ///
    /// # Errors
    /// It cannot be read, or a line is no item, or was changed.
    pub fn open(path: &Path) -> Result<BakePlan, EngineError> {
        let said = |why: &str| format!("{}: {why}", path.display());
        let bytes = read_plain(path, SIZE_LIMIT_BYTES).map_err(|unread| {
            let why = why_unread(&unread, ".jsonl", "plans", SIZE_LIMIT_BYTES);
            EngineError::new(kind_of_unread(&unread), said(&why))
        })?;
        let bad = |why: &str| EngineError::new(ErrorKind::BadInput, said(why));
        let text = String::from_utf8(bytes).map_err(|_| bad("this is no text, and so no plan"))?;
        let folder = path.parent().unwrap_or(Path::new("")); // A bare name refers to the current folder.
        let base = canonical(folder).map_err(|error| bad(&io_reason(&error)))?;
        let base = PathBase::of_folder(base);
        let mut items = Vec::new();
        for (at, line) in text.lines().enumerate() {
            let item = BakeItem::of_line(line, at);
            let item = item.map_err(|why| {
                let why = format!("{}:{}: {why}", path.display(), at + 1);
                EngineError::new(ErrorKind::BadInput, why)
            })?;
            items.push(item);
        }
        match items.is_empty() {
            true => Err(bad("the plan has no items")),
            false => Ok(BakePlan { base, items }),
        }
    }

    /// Refuses to replace a file that is not a plan.
    ///
    /// # Errors
    /// There is such a file. Other reasons why a plan cannot be written are found by [`BakePlan::write`].
    pub fn refuse_other_file(path: &Path) -> Result<(), EngineError> {
        let refused = |why: &str| Err(unwritten(path, why));
        let Ok(found) = fs::metadata(path) else {
            return Ok(());
        };
        // Opening a pipe could block forever.
        if !found.is_file() {
            return refused("it is no ordinary file");
        }
        let mut start = Vec::new();
        let read = File::open(path).and_then(|file| file.take(START.len() as u64).read_to_end(&mut start));
        match read.is_ok() && (start.is_empty() || start == START) {
            true => Ok(()),
            false => refused("there is a file that is no plan"),
        }
    }

    /// Writes its file, as a whole.
    ///
    /// # Errors
    /// An item cannot be written as JSON, or the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), EngineError> {
        write_whole(path, self.to_text()?.as_bytes()).map_err(|error| unwritten(path, &io_reason(&error.source)))
    }

    /// Returns the text of its file.
    ///
    /// # Errors
    /// An item cannot be written as JSON.
    pub fn to_text(&self) -> Result<String, EngineError> {
        let mut text = String::new();
        for item in &self.items {
            let line = serde_json::to_string(item).map_err(|error| EngineError::of(ErrorKind::Defect, error))?;
            text.push_str(&line);
            text.push('\n');
        }
        Ok(text)
    }
}

fn unwritten(path: &Path, why: &str) -> EngineError {
    let why = format!("cannot write the plan {}: {why}; name another file", path.display());
    EngineError::new(ErrorKind::CannotWrite, why)
}

impl BakeItem {
    /// Reads the line with this index; the error is a clause.
    fn of_line(line: &str, at: usize) -> Result<BakeItem, String> {
        let item: BakeItem =
            serde_json::from_str(line).map_err(|error| format!("this is no item of a plan: {error}; plan again"))?;
        if item.item != at {
            return Err(format!(
                "this is item {}, and its place is that of item {at}; plan again",
                item.item
            ));
        }
        if item.hashed().ok().as_ref() != Some(&item.key) {
            return Err(format!(
                "item {at} was changed after it was planned; change the matrix and plan again"
            ));
        }
        Ok(item)
    }
}
