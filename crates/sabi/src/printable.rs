//! Makes text safe to print: nothing that came from a file controls a terminal, breaks a line, or is taken for a
//! command by a system that reads the output of jobs.

use std::borrow::Cow;
use std::fmt::{self, Write as _};
use std::io;
use std::path::Path;

use sabi_files::is_invisible;

/// Starts of the lines that follow the sentence of a fault in a node file.
const CONTINUATIONS: [&str; 2] = ["   | ", "   = "];
/// Starts of lines that Open Job Description and GitHub treat as commands.
const COMMANDS: [&str; 2] = ["openjd_", "::"];
/// Marks that GitHub, Azure and TeamCity search for anywhere in a line.
const MARKS: &str = "##";
/// Greatest length of a line, in bytes.
const LONGEST_LINE: usize = 16 << 10;
/// Number of bytes that are kept of a longer line at its beginning and at its end.
const LEFT_OF_LINE: usize = 4 << 10;

/// Returns a sentence as one line. The lines that follow the sentence of a fault in a node file are kept.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    let text = shortened(text);
    let is_plain = |text: &str| {
        !text.chars().any(is_invisible) && !text.contains(MARKS) && !COMMANDS.iter().any(|start| starts(text, start))
    };
    if is_plain(&text) {
        return text;
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for (at, letter) in text.char_indices() {
        let rest = &text[at + letter.len_utf8()..];
        match letter {
            '\n' if CONTINUATIONS.iter().any(|start| rest.starts_with(start)) => shown.push('\n'),
            '#' if rest.starts_with('#') => escape(&mut shown, letter),
            letter if is_invisible(letter) => escape(&mut shown, letter),
            letter => shown.push(letter),
        }
    }
    if COMMANDS.iter().any(|start| starts(&shown, start)) {
        let spaces = shown.len() - shown.trim_start().len();
        let (before, rest) = shown.split_at(spaces);
        let mut letters = rest.chars();
        let mut broken = before.to_owned();
        if let Some(first) = letters.next() {
            escape(&mut broken, first);
        }
        broken.push_str(letters.as_str());
        shown = broken;
    }
    Cow::Owned(shown)
}

/// Returns a path as one line for scripts, which open the file of these bytes: what is no text stays as it is. Characters of its text
/// that control a terminal are escaped.
#[cfg(unix)]
pub(crate) fn printable_path(path: &Path) -> Vec<u8> {
    use std::os::unix::ffi::OsStrExt as _;

    let mut shown = Vec::new();
    for chunk in path.as_os_str().as_bytes().utf8_chunks() {
        shown.extend(printable(chunk.valid()).as_bytes());
        shown.extend(chunk.invalid());
    }
    shown
}

/// Returns a path as one line.
#[cfg(not(unix))]
pub(crate) fn printable_path(path: &Path) -> Vec<u8> {
    printable(&path.display().to_string()).into_owned().into_bytes()
}

/// Returns a text of several lines, such as a file, with its line breaks and tabs but without characters that control a
/// terminal. Only lines that a system would take for a command differ otherwise.
pub(crate) fn printable_lines(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (line, end) = line.strip_suffix('\n').map_or((line, ""), |line| (line, "\n"));
        if is_command(line) {
            shown.push_str(&printable(line));
        } else {
            for letter in line.chars() {
                match letter {
                    '\t' => shown.push(letter),
                    letter if is_invisible(letter) => escape(&mut shown, letter),
                    letter => shown.push(letter),
                }
            }
        }
        shown.push_str(end);
    }
    shown
}

/// Returns true for a line that such systems treat as a command, such as `::error::` or `##vso[task]`. A heading in a
/// comment, such as `## Maps`, is none.
fn is_command(line: &str) -> bool {
    let is_marked = |(at, _): (usize, &str)| {
        let name = line[at..].trim_start_matches('#');
        name.trim_start_matches(|letter: char| letter.is_ascii_alphabetic())
            .starts_with('[')
    };
    COMMANDS.iter().any(|start| starts(line, start)) || line.match_indices(MARKS).any(is_marked)
}

/// Returns a JSON document with the same meaning, in which no string controls a terminal or is taken for a command.
pub(crate) fn printable_json(json: &str) -> Cow<'_, str> {
    let is_odd = |letter: char| letter != '\n' && is_invisible(letter);
    if !json.contains(is_odd) && !json.contains(MARKS) {
        return Cow::Borrowed(json);
    }
    let mut shown = String::with_capacity(json.len() + 16);
    for (at, letter) in json.char_indices() {
        // Such characters occur only in strings; those above U+FFFF are written as two `\u` escapes.
        if is_odd(letter) || letter == '#' && json[at + 1..].starts_with('#') {
            for unit in letter.encode_utf16(&mut [0; 2]) {
                let _ = write!(shown, "\\u{unit:04x}");
            }
        } else {
            shown.push(letter);
        }
    }
    Cow::Owned(shown)
}

fn starts(text: &str, command: &str) -> bool {
    let start = text.trim_start().get(..command.len());
    start.is_some_and(|start| start.eq_ignore_ascii_case(command))
}

fn escape(shown: &mut String, letter: char) {
    let _ = match letter {
        '\n' => shown.write_str("\\n"),
        '\r' => shown.write_str("\\r"),
        '\t' => shown.write_str("\\t"),
        letter => write!(shown, "\\u{{{:x}}}", u32::from(letter)),
    };
}

/// Leaves out the middle of a line that is too long to be read.
fn shortened(text: &str) -> Cow<'_, str> {
    if text.len() <= LONGEST_LINE {
        return Cow::Borrowed(text);
    }
    let start = text.floor_char_boundary(LEFT_OF_LINE);
    let end = text.ceil_char_boundary(text.len() - LEFT_OF_LINE);
    Cow::Owned(format!(
        "{} [… {} bytes are left out …] {}",
        &text[..start],
        end - start,
        &text[end..]
    ))
}

/// Text for people, made of lines.
#[derive(Debug, Default)]
pub(crate) struct Page(String);

impl Page {
    /// Adds a line.
    pub(crate) fn line(&mut self, line: impl fmt::Display) {
        self.0.push_str(&printable(&line.to_string()));
        self.0.push('\n');
    }

    /// Adds the lines of a text.
    pub(crate) fn lines(&mut self, text: &str) {
        text.lines().for_each(|line| self.line(line));
    }

    /// Returns the page as text.
    pub(crate) fn text(&self) -> &str {
        &self.0
    }
}

impl<L: fmt::Display> FromIterator<L> for Page {
    fn from_iter<I: IntoIterator<Item = L>>(lines: I) -> Page {
        let mut page = Page::default();
        lines.into_iter().for_each(|line| page.line(line));
        page
    }
}

/// Writer of a log. Each of its writes is one entry.
pub(crate) struct LogWriter<W>(pub(crate) W);

impl<W: io::Write> io::Write for LogWriter<W> {
    fn write(&mut self, entry: &[u8]) -> io::Result<usize> {
        let text = String::from_utf8_lossy(entry);
        let line = printable(text.strip_suffix('\n').unwrap_or(&text));
        self.0.write_all(format!("{line}\n").as_bytes())?;
        Ok(entry.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn nothing_in_a_sentence_controls_a_terminal_or_breaks_its_line() {
        for (text, shown) in [
            ("unknown kind 'ä/b' in C:\\x", "unknown kind 'ä/b' in C:\\x"),
            ("a\nopenjd_env: PATH=x", "a\\nopenjd_env: PATH=x"),
            ("a\r\u{1b}[2J\u{7f}\u{9b}", "a\\r\\u{1b}[2J\\u{7f}\\u{9b}"),
            ("exe.\u{202e}gnp", "exe.\\u{202e}gnp"),
            ("a\u{2028}b\tc", "a\\u{2028}b\\tc"),
            ("openjd_env: A=b", "\\u{6f}penjd_env: A=b"),
            ("  OpenJD_fail: x", "  \\u{4f}penJD_fail: x"),
            (" ::error::x", " \\u{3a}:error::x"),
            ("x ##vso[task] ###[y]", "x \\u{23}#vso[task] \\u{23}\\u{23}#[y]"),
            ("a::b # c #", "a::b # c #"),
            (
                "a.wgsl:1:2: No.\n   | x\n   = Do.\n   y",
                "a.wgsl:1:2: No.\n   | x\n   = Do.\\n   y",
            ),
            ("", ""),
        ] {
            assert_eq!(printable(text), shown, "{text:?}");
        }
    }

    #[test]
    #[cfg(unix)]
    fn a_path_keeps_bytes_that_are_no_text_but_controls_no_terminal() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt as _;

        let shown = |bytes: &[u8]| printable_path(Path::new(OsStr::from_bytes(bytes)));
        assert_eq!(shown(b"p\xff/\xe4.png"), b"p\xff/\xe4.png");
        assert_eq!(shown("ä/錆.png".as_bytes()), "ä/錆.png".as_bytes());
        assert_eq!(shown(b"\xff\n\x1b[2J\xe4"), b"\xff\\n\\u{1b}[2J\xe4");
    }

    #[test]
    fn a_line_is_no_longer_than_anyone_reads() {
        let long = format!("begin {} end", "ä".repeat(20 << 20));
        let shown = printable(&long);
        assert!(shown.len() < LONGEST_LINE && shown.starts_with("begin ") && shown.ends_with(" end"));
        assert!(shown.contains("bytes are left out"));
    }

    #[test]
    fn a_json_document_keeps_its_meaning() {
        for text in ["a\u{1b}\u{7f}\u{9b}b", "\u{202e}##vso[x]", "\u{e0041}###", "plain ä 錆"] {
            let json = serde_json::to_string_pretty(&[text]).unwrap();
            let shown = printable_json(&json);
            assert!(
                !shown.chars().any(|letter| letter != '\n' && is_invisible(letter)),
                "{shown}"
            );
            assert!(!shown.contains("##"), "{shown}");
            assert_eq!(serde_json::from_str::<[String; 1]>(&shown).unwrap(), [text]);
        }
    }

    #[test]
    fn an_entry_of_a_log_is_one_line() {
        let mut log = Vec::new();
        LogWriter(&mut log).write_all(b"path=a\nopenjd_env: x\r\n").unwrap();
        assert_eq!(String::from_utf8(log).unwrap(), "path=a\\nopenjd_env: x\\r\n");
    }

    #[test]
    fn the_lines_of_a_page_are_those_that_the_program_made() {
        let mut page: Page = ["one\ntwo", "::warning::"].into_iter().collect();
        page.lines("a\nopenjd_env: b");
        assert_eq!(page.text(), "one\\ntwo\n\\u{3a}:warning::\na\n\\u{6f}penjd_env: b\n");
        let plain = "a = 1\n\t# ## x\u{1b}\n## [maps]\nend";
        assert_eq!(printable_lines(plain), "a = 1\n\t# ## x\\u{1b}\n## [maps]\nend");
        let commands = "'''\n::error::x\nopenjd_env: a\nx ##vso[y] ##[z]\n";
        let broken = "'''\n\\u{3a}:error::x\n\\u{6f}penjd_env: a\nx \\u{23}#vso[y] \\u{23}#[z]\n";
        assert_eq!(printable_lines(commands), broken);
    }
}
