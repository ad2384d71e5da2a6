//! Reads the header of a node file: the `//!` lines at its start.

use crate::annotations::{AnnotationWord, DocComment, HEADER_ANNOTATIONS};
use crate::fault::{Fault, Text};
use crate::scan::Scan;

/// Content of the `//!` lines.
#[derive(Clone, Debug)]
pub(crate) struct Header {
    pub(crate) label: String,
    pub(crate) summary: String,
    pub(crate) description: String,
    pub(crate) aliases: Vec<String>,
    pub(crate) formerly: Vec<String>,
    pub(crate) version: u32,
}

/// Reads the header, and the libraries that it names with `@use`. Returns no header if the label or the summary is missing.
pub(crate) fn read_header(
    text: Text<'_>,
    scan: &Scan,
    faults: &mut Vec<Fault>,
) -> (Option<Header>, Vec<AnnotationWord>) {
    let comment = DocComment::read(&scan.header);
    let uses = comment
        .all("use")
        .flat_map(|annotation| annotation.words.clone())
        .collect();
    comment.check(text, HEADER_ANNOTATIONS, &["version"], faults);
    let mut lines = comment.lines.iter().map(|line| line.trim_end());
    let label = lines.find(|line| !line.is_empty());
    let summary = lines.find(|line| !line.is_empty());
    let description = lines.collect::<Vec<_>>().join("\n").trim().to_owned();
    if summary.is_none() {
        let missing = if label.is_none() { "name" } else { "summary" };
        let range = scan
            .header
            .first()
            .map_or(0..0, |line| line.start..line.start + line.text.len());
        faults.push(text.fault(
            range,
            format!("The header gives no {missing} for the node."),
            "Start the file with `//! Name` and, in the next line, `//! One sentence that says what it does.`",
        ));
    }
    for name in ["alias", "use", "was"] {
        for annotation in comment.all(name).filter(|annotation| annotation.words.is_empty()) {
            faults.push(text.fault(
                annotation.range.clone(),
                format!("`@{name}` names nothing."),
                "Write the names behind it.",
            ));
        }
    }
    let gather = |name: &'static str| {
        let words = comment.all(name).flat_map(|annotation| annotation.words.iter());
        words.map(|word| word.text.trim_end_matches(',').to_owned()).collect()
    };
    let version = version(text, &comment, faults);
    let header = label.zip(summary).map(|(label, summary)| Header {
        label: label.trim().to_owned(),
        summary: summary.trim().to_owned(),
        description,
        aliases: gather("alias"),
        formerly: gather("was"),
        version,
    });
    (header, uses)
}

/// Reads `@version N`. Without this annotation the version is 1.
fn version(text: Text<'_>, comment: &DocComment, faults: &mut Vec<Fault>) -> u32 {
    let Some(annotation) = comment.get("version") else {
        return 1;
    };
    match annotation.joined().parse::<u32>() {
        Ok(number) if number > 0 => number,
        _ => {
            faults.push(text.fault(
                annotation.whole(),
                "`@version` takes one whole number from 1 on.",
                "Write `@version 2` when the algorithm gives other results than before.",
            ));
            1
        }
    }
}
