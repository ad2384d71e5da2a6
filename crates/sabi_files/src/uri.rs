//! URI references in files (RFC 3986): embedded data, or the path of another file.

use std::borrow::Cow;

/// URI reference in a file, by what it refers to.
#[derive(Debug, PartialEq)]
pub enum Uri<'a> {
    /// Bytes that the URI contains.
    Data(Vec<u8>),
    /// Path relative to the file, percent-decoded. Of a `file:` address, which is one of another computer, the last part.
    Beside(Cow<'a, str>),
    /// Embedded data that is damaged, with the reason.
    Damaged(String),
    /// Address that is not read, with the reason.
    Unusable(String),
}

impl<'a> Uri<'a> {
    /// Parses a URI reference.
    pub fn parse(uri: &'a str) -> Uri<'a> {
        if let Some(rest) = uri
            .get(..5)
            .filter(|head| head.eq_ignore_ascii_case("data:"))
            .map(|_| &uri[5..])
        {
            return data(rest);
        }
        let scheme = uri.split_once([':', '/', '\\', '?']).map_or(uri, |(scheme, _)| scheme);
        let is_file = scheme.eq_ignore_ascii_case("file") && uri[scheme.len()..].starts_with(':');
        let uri = match uri.rsplit_once(['/', '\\', ':']) {
            Some((_, name)) if is_file => name,
            _ => uri,
        };
        let scheme = if is_file { "" } else { scheme };
        // One letter is a drive, not a scheme.
        if scheme.len() > 1 && uri[scheme.len()..].starts_with(':') && scheme.bytes().all(is_scheme_byte) {
            return Uri::Unusable(format!("`{scheme}:` addresses are not fetched"));
        }
        match percent_decoded(uri).map(String::from_utf8) {
            Some(Ok(path)) if path != uri => Uri::Beside(Cow::Owned(path)),
            _ => Uri::Beside(Cow::Borrowed(uri)),
        }
    }
}

/// Looks for the file of a [`Uri::Beside`] under its decoded path, then as the URI is written, since names may contain `%`, `?` and `#`,
/// then without the query and the fragment of the URI, which say nothing to a file system.
///
/// # Errors
/// The first of the reasons of `find`.
pub fn find_beside<T, E>(uri: &str, decoded: &str, mut find: impl FnMut(&str) -> Result<T, E>) -> Result<T, E> {
    find(decoded).or_else(|reason| {
        find(uri).or_else(|_| match uri.find(['?', '#']).map(|end| Uri::parse(&uri[..end])) {
            Some(Uri::Beside(path)) => find(&path).map_err(|_| reason),
            _ => Err(reason),
        })
    })
}

/// Returns the URI that contains `bytes`, in base64 (RFC 2397).
pub fn data_uri(media_type: &str, bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut uri = format!("data:{media_type};base64,");
    uri.reserve(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits = group.iter().fold(0, |bits, byte| bits << 8 | u32::from(*byte)) << (8 * (3 - group.len()));
        for digit in 0..4 {
            let value = bits >> (18 - 6 * digit) & 63;
            uri.push(if digit > group.len() {
                '='
            } else {
                char::from(DIGITS[value as usize])
            });
        }
    }
    uri
}

fn is_scheme_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'+' | b'.' | b'-')
}

fn data(rest: &str) -> Uri<'_> {
    let Some((head, body)) = rest.split_once(',') else {
        return Uri::Damaged("its data URI has no comma before the data".into());
    };
    let bytes = if head.to_ascii_lowercase().ends_with(";base64") {
        percent_decoded(body).and_then(|body| base64(&body))
    } else {
        percent_decoded(body)
    };
    match bytes {
        Some(bytes) => Uri::Data(bytes),
        None => Uri::Damaged("its data URI is not proper base64".into()),
    }
}

/// Decodes percent encoding; `None` if a `%` is not followed by two hexadecimal digits.
fn percent_decoded(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if *first == b'%' {
            let [high, low, tail @ ..] = rest else { return None };
            let digit = |byte: &u8| char::from(*byte).to_digit(16);
            out.push((digit(high)? * 16 + digit(low)?) as u8);
            rest = tail;
        } else {
            out.push(*first);
        }
    }
    Some(out)
}

/// Decodes base64 of either alphabet, padded or not (RFC 4648); `None` if the text is not base64.
fn base64(text: &[u8]) -> Option<Vec<u8>> {
    let end = text.iter().rposition(|byte| *byte != b'=').map_or(0, |last| last + 1);
    if text.len() - end > 2 {
        return None;
    }
    let mut out = Vec::with_capacity(end / 4 * 3 + 3);
    let (mut bits, mut held) = (0u32, 0);
    for byte in &text[..end] {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            out.push((bits >> held) as u8);
            bits &= (1 << held) - 1;
        }
    }
    // A single remaining digit cannot form a byte.
    (held < 6).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_of_every_length_are_restored_from_their_uri() {
        // RFC 4648, 10.
        for (text, base64) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(
                data_uri("text/plain", text.as_bytes()),
                format!("data:text/plain;base64,{base64}")
            );
        }
        let all: Vec<u8> = (0..=255).rev().collect();
        for length in 0..all.len() {
            let uri = data_uri("a/b", &all[..length]);
            assert_eq!(Uri::parse(&uri), Uri::Data(all[..length].to_vec()));
        }
    }

    #[test]
    fn a_uri_is_parsed() {
        let beside = |path: &str| Uri::Beside(Cow::Owned(path.to_string()));
        let damaged = |reason: &str| Uri::Damaged(reason.to_string());
        let unusable = |reason: &str| Uri::Unusable(reason.to_string());
        for (uri, expected) in [
            (
                "data:application/octet-stream;base64,AAECAw==",
                Uri::Data(vec![0, 1, 2, 3]),
            ),
            ("data:;base64,AAECAw", Uri::Data(vec![0, 1, 2, 3])),
            ("DATA:;BASE64,-_8=", Uri::Data(vec![0xfb, 0xff])),
            ("data:,a%20b", Uri::Data(b"a b".to_vec())),
            ("data:;base64,A", damaged("its data URI is not proper base64")),
            ("data:;base64,A!==", damaged("its data URI is not proper base64")),
            ("data:;base64,AAAA====", damaged("its data URI is not proper base64")),
            ("data:base64", damaged("its data URI has no comma before the data")),
            ("Box%20With%20Spaces.bin", beside("Box With Spaces.bin")),
            ("100%.bin", beside("100%.bin")),
            ("a/b.bin", beside("a/b.bin")),
            ("C:\\a.bin", beside("C:\\a.bin")),
            ("file:///C:/My%20work/a%20b.bin", beside("a b.bin")),
            ("FILE:\\\\C:\\a.bin", beside("a.bin")),
            (
                "https://example.org/a.bin",
                unusable("`https:` addresses are not fetched"),
            ),
            ("", beside("")),
        ] {
            assert_eq!(Uri::parse(uri), expected, "{uri}");
        }
    }
}
