//! The tree of elements, and properties of the whole file.

use sabi_cancel::CancelableIterator as _;
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::HashMap;

use glam::{DMat4, DVec3};
use roxmltree::{Node, ParsingOptions};

use super::missing::{MissingReferences, is_meant};
use crate::load::Up;
use crate::load::error::{ModelFault, damaged};
use crate::load::numbers::number;
use crate::load::warnings::Warnings;

/// Maximum number of attributes of an element. The parser compares each attribute with all before it. Elements of COLLADA
/// have ten at most.
const MOST_ATTRIBUTES: usize = 1000;

/// Memory of an element with the text behind it.
const ELEMENT_BYTES: u64 = 192;
/// Memory of an attribute.
const ATTRIBUTE_BYTES: u64 = 80;

/// Parses the text, whose tree takes at most `memory_bytes`; definitions of entities, by which a short text may become a long one, are
/// refused.
pub(super) fn parsed(text: &str, memory_bytes: u64) -> Result<roxmltree::Document<'_>, ModelFault> {
    if let Some(count) = most_attributes(text).filter(|count| *count > MOST_ATTRIBUTES) {
        return damaged(format!(
            "one of its elements has {count} attributes, and at most {MOST_ATTRIBUTES} are read"
        ));
    }
    let count = |mark: u8| text.bytes().filter(|byte| *byte == mark).count() as u64;
    let needed = ELEMENT_BYTES * count(b'<') + ATTRIBUTE_BYTES * count(b'=');
    if needed > memory_bytes {
        return Err(ModelFault::memory(needed, memory_bytes));
    }
    if text.contains("<!ENTITY") {
        return damaged("it defines entities (`<!ENTITY`), which a COLLADA file has no use for");
    }
    let options = ParsingOptions {
        // A document type without entities is a mere name, and nothing is fetched for it.
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    roxmltree::Document::parse_with_options(text, options)
        .or_else(|error| damaged(format!("its XML cannot be read ({error})")))
}

/// Returns the largest number of attributes of any element, counted by equals signs outside of quotes; `None` if there are
/// no elements. Text and comments that look like elements are counted, too.
fn most_attributes(text: &str) -> Option<usize> {
    let tags = text.split('<').skip(1);
    let count = |tag: &str| {
        let (mut count, mut quote) = (0, None);
        for letter in tag.bytes() {
            match (quote, letter) {
                (Some(open), letter) if letter == open => quote = None,
                (Some(_), _) => {}
                (None, b'"' | b'\'') => quote = Some(letter),
                (None, b'=') => count += 1,
                (None, b'>') => break,
                (None, _) => {}
            }
        }
        count
    };
    tags.map(count).max()
}

/// Elements of the file, by their ids.
pub(super) struct DaeDocument<'d> {
    pub(super) root: Node<'d, 'd>,
    ids: HashMap<&'d str, Node<'d, 'd>>,
    missing: RefCell<MissingReferences<'d>>,
    /// Transform to meters and +Y up.
    pub(super) file_from_scene: DMat4,
}

impl<'d> DaeDocument<'d> {
    pub(super) fn new(
        tree: &'d roxmltree::Document<'d>,
        warnings: &mut Warnings,
    ) -> Result<DaeDocument<'d>, ModelFault> {
        let root = tree.root_element();
        if root.tag_name().name() != "COLLADA" {
            return damaged("it is no COLLADA file");
        }
        let mut ids = HashMap::new();
        for node in root.descendants().looking() {
            if let Some(id) = node.attribute("id") {
                ids.entry(id).or_insert(node);
            }
        }
        let asset = child(root, "asset");
        let unit = asset.and_then(|asset| child(asset, "unit")?.attribute("meter"));
        // If the file declares no unit, it is a meter.
        let unit = unit.map_or(1.0, |unit| meters(unit, warnings));
        let up = asset.and_then(|asset| child(asset, "up_axis")).map(text);
        let up = match up.as_deref() {
            Some("Z_UP") => Up::Z,
            Some("X_UP") => Up::X,
            None | Some("Y_UP" | "") => Up::Y,
            Some(other) => {
                warnings.add(format!(
                    "The file has the unknown axis `{other}` up; +Y is taken to point up."
                ));
                Up::Y
            }
        };
        Ok(DaeDocument {
            root,
            ids,
            missing: RefCell::default(),
            file_from_scene: DMat4::from_mat3(up.turned()) * DMat4::from_scale(DVec3::splat(unit)),
        })
    }

    /// The element of an id.
    pub(super) fn by_id(&self, id: &str) -> Option<Node<'d, 'd>> {
        self.ids.get(id).copied()
    }

    /// Returns the element to which an attribute of a node refers by a reference such as `#shape`. Of an element that is not there, the
    /// reference is recorded.
    pub(super) fn referenced(&self, node: Node<'d, 'd>, attribute: &str) -> Option<Node<'d, 'd>> {
        let reference = node.attribute(attribute)?;
        let target = reference.strip_prefix('#').and_then(|id| self.by_id(id));
        let target = target.filter(|target| is_meant(node, *target));
        if target.is_none() {
            self.note_missing(node, reference);
        }
        target
    }

    /// Records a reference that leads nowhere.
    pub(super) fn note_missing(&self, node: Node<'d, 'd>, reference: &'d str) {
        self.missing.borrow_mut().add(node, reference);
    }

    /// Adds warnings about the references that led nowhere.
    pub(super) fn tell_missing(&self, warnings: &mut Warnings) {
        self.missing.borrow().tell(warnings);
    }

    /// The first library of a name.
    pub(super) fn first(&self, library: &str) -> Option<Node<'d, 'd>> {
        child(self.root, library)
    }
}

/// Returns the length of a file's unit in meters; 1 if it is not a valid length.
fn meters(written: &str, warnings: &mut Warnings) -> f64 {
    let length = number(written.trim(), warnings);
    length
        .filter(|length| length.is_finite() && *length > 0.0)
        .unwrap_or_else(|| {
            warnings.add(format!(
                "The unit of the file is `{written}` meters, which is no length; it is taken as 1 meter."
            ));
            1.0
        })
}

/// The first element below a node with a name.
pub(super) fn child<'d>(node: Node<'d, 'd>, name: &str) -> Option<Node<'d, 'd>> {
    children(node, name).next()
}

/// The elements below a node with a name.
pub(super) fn children<'d, 'n>(node: Node<'d, 'd>, name: &'n str) -> impl Iterator<Item = Node<'d, 'd>> + use<'d, 'n> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

/// The text of an element, trimmed. Comments and processing instructions divide a text without ending it (XML 1.0, 2.5 and 2.6).
pub(super) fn text<'d>(node: Node<'d, 'd>) -> Cow<'d, str> {
    let mut texts = node
        .children()
        .filter_map(|child| child.text().filter(|_| child.is_text()));
    let first = texts.next().unwrap_or_default();
    let Some(second) = texts.next() else {
        return Cow::Borrowed(first.trim());
    };
    let whole: String = [first, second].into_iter().chain(texts).looking().collect();
    Cow::Owned(whole.trim().to_owned())
}

/// Returns the numbers of a text. Words that are not numbers become NaN.
pub(super) fn numbers(node: Node<'_, '_>, warnings: &mut Warnings) -> Vec<f64> {
    let text = text(node);
    let words = text.split_ascii_whitespace();
    let numbers = words.looking().map(|word| number(word, warnings).unwrap_or(f64::NAN));
    numbers.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_counted_outside_of_quotes() {
        for (text, count) in [
            ("", None),
            ("<a/>", Some(0)),
            ("<a b='1' c = \"<\"><d e='x=y=z>='/> f=g=h </a>", Some(2)),
            ("<a b='it\"s' c=\"'\" d=''>", Some(3)),
        ] {
            assert_eq!(most_attributes(text), count, "{text}");
        }
    }

    #[test]
    fn an_element_of_many_attributes_is_refused_before_it_is_parsed() {
        let attributes: String = (0..300_000).map(|number| format!(" a{number}='1'")).collect();
        let text = format!("<COLLADA><asset{attributes}/></COLLADA>");
        let told = parsed(&text, u64::MAX).map(|_| ()).unwrap_err().to_string();
        assert!(
            told.contains("one of its elements has 300000 attributes, and at most 1000 are read"),
            "{told}"
        );
        let attributes: String = (0..1000).map(|number| format!(" a{number}='1'")).collect();
        assert!(parsed(&format!("<COLLADA{attributes}/>"), u64::MAX).is_ok());
    }
}
