//! Files of bake plans: one item a line, as JSON.

use std::path::Path;

use sabi_files::{PathBase, canonical, io_reason, read_plain};

use super::item::BakeItem;
use crate::error::{EngineError, ErrorKind};
use crate::opening::unread::{kind_of_unread, why_unread};

/// Maximum size. Larger files are refused before they are read.
const SIZE_LIMIT_BYTES: u64 = 1 << 30;

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
