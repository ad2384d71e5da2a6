//! XML elements as text.

/// Element without text of its own.
#[derive(Clone, Debug)]
pub(super) struct XmlElement {
    tag: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<XmlElement>,
}

impl XmlElement {
    /// An element without attributes.
    pub(super) fn new(tag: &'static str) -> XmlElement {
        XmlElement {
            tag,
            attributes: Vec::new(),
            children: Vec::new(),
        }
    }

    /// Adds an attribute.
    pub(super) fn with(mut self, name: &'static str, value: impl Into<String>) -> XmlElement {
        self.attributes.push((name, value.into()));
        self
    }

    /// Adds an element inside.
    pub(super) fn holding(mut self, child: XmlElement) -> XmlElement {
        self.children.push(child);
        self
    }

    /// Adds elements inside.
    pub(super) fn extend(&mut self, children: impl IntoIterator<Item = XmlElement>) {
        self.children.extend(children);
    }

    /// The text of a document with this element as its root.
    pub(super) fn document(&self) -> String {
        let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
        self.write(&mut text, 0);
        text
    }

    fn write(&self, text: &mut String, depth: usize) {
        let indent = "  ".repeat(depth);
        text.push_str(&format!("{indent}<{}", self.tag));
        for (name, value) in &self.attributes {
            text.push_str(&format!(" {name}=\"{}\"", escaped(value)));
        }
        if self.children.is_empty() {
            text.push_str(" />\n");
            return;
        }
        text.push_str(">\n");
        for child in &self.children {
            child.write(text, depth + 1);
        }
        text.push_str(&format!("{indent}</{}>\n", self.tag));
    }
}

/// A value between quotes; letters that XML 1.0 does not have (2.2, Char) are replaced.
fn escaped(value: &str) -> String {
    let mut text = String::new();
    for letter in value.chars() {
        match letter {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' | '\0'..='\u{1f}' => text.push('\u{fffd}'),
            other => text.push(other),
        }
    }
    text
}
