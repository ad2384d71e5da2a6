//! Lines on which functions begin and end, in formatted Rust and WGSL.

/// Name, line and length of each function. The formatter puts a body's last brace below the start of its signature, so
/// indentation says more than counting braces, which stand in texts and comments too.
pub(crate) fn functions_of(text: &str) -> Vec<(String, usize, usize)> {
    let text = without_texts(text);
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let Some(name) = function_name(line) else { continue };
        let indent = &line[..line.len() - line.trim_start().len()];
        let is_last = |line: &str| {
            line.strip_prefix(indent)
                .is_some_and(|rest| rest == "}" || rest.ends_with(';') && rest.starts_with(')'))
        };
        let fits_one_line = line.ends_with('}') || line.ends_with(';');
        let rest = if fits_one_line {
            Some(0)
        } else {
            lines[start..].iter().position(|line| is_last(line))
        };
        found.push((name, start + 1, rest.unwrap_or(lines.len() - start - 1) + 1));
    }
    found
}

/// The same lines with quoted texts and comments taken out: a shader inside a test is not a function of the test.
pub(crate) fn without_texts(text: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = skipped(rest, kept.chars().next_back());
        let (taken, after) = rest.split_at(length.max(first.len_utf8()));
        if length > 0 {
            kept.extend(taken.chars().filter(|c| *c == '\n'));
        } else {
            kept.push(first);
        }
        rest = after;
    }
    kept
}

/// Length in bytes of a comment, quoted text or quoted character that begins here; 0 if `rest` begins with code.
pub(crate) fn skipped(rest: &str, before: Option<char>) -> usize {
    let through = |end: Option<usize>, length: usize| end.map_or(rest.len(), |end| end + length);
    if rest.starts_with("//") {
        return through(rest.find('\n'), 0);
    }
    if rest.starts_with("/*") {
        return through(rest.find("*/"), 2);
    }
    if let Some(quoted) = rest.strip_prefix('"') {
        let mut escaped = false;
        let end = quoted.find(|c| {
            let ends = c == '"' && !escaped;
            escaped = c == '\\' && !escaped;
            ends
        });
        return through(end, 2);
    }
    let in_a_name = before.is_some_and(|c| c.is_alphanumeric() || c == '_');
    let hashes = rest
        .strip_prefix('r')
        .map_or(0, |raw| raw.len() - raw.trim_start_matches('#').len());
    if !in_a_name && rest.starts_with('r') && rest[1 + hashes..].starts_with('"') {
        let start = 2 + hashes;
        let end = format!("\"{}", "#".repeat(hashes));
        return through(rest[start..].find(&end).map(|at| start + at), end.len());
    }
    let quoted = ["'\"'", "'{'", "'}'", "'/'", "'\\\"'", "'\\''"];
    quoted
        .iter()
        .find(|quoted| rest.starts_with(**quoted))
        .map_or(0, |quoted| quoted.len())
}

/// The name that a line declares as a function's.
fn function_name(line: &str) -> Option<String> {
    let mut rest = line.trim_start();
    for word in ["pub(crate) ", "pub(super) ", "pub ", "default ", "const ", "async "] {
        rest = rest.strip_prefix(word).unwrap_or(rest);
    }
    let name: String = rest
        .strip_prefix("fn ")?
        .chars()
        .take_while(|c| c.is_alphanumeric() || *c == '_')
        .collect();
    (!name.is_empty()).then_some(name)
}

#[test]
fn functions_are_measured_from_signature_to_last_brace() {
    let text = "fn one() {}\n\nimpl A {\n    pub(crate) const fn two(\n        a: u8,\n    ) -> u8 {\n        match a {\n            _ => 1,\n        }\n    }\n    fn three();\n}\n";
    assert_eq!(
        functions_of(text),
        [("one".into(), 1, 1), ("two".into(), 4, 7), ("three".into(), 11, 1)]
    );
}

#[test]
fn a_function_inside_a_text_is_not_measured() {
    let text = "fn one() {\n    let a = r#\"\nfn two() {\n}\n\"#;\n    let b = \"\\\"fn x() {\n\"; // fn y()\n    c('\"');\n}\n";
    assert_eq!(functions_of(text), [("one".into(), 1, 9)]);
}
