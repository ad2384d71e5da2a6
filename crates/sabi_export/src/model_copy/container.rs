//! What a glTF document comes in: a file of its own, or a GLB container with a binary chunk.

use serde_json::{Value as Json, json};

/// Cuts keep the alignment of what stands behind them: a multiple of every element size that glTF knows.
const ALIGNMENT: usize = 16;
const JSON_CHUNK: &[u8] = b"JSON";
const BINARY_CHUNK: &[u8] = b"BIN\0";

/// A container without its JSON.
#[derive(Debug)]
pub(super) struct Container {
    is_glb: bool,
    /// The binary chunk, which is buffer 0; none where the file has none.
    binary: Option<Vec<u8>>,
    /// Chunks of other kinds, headers included.
    others: Vec<u8>,
}

/// Whether bytes without a telling name are a glTF file.
pub(super) fn looks_like_gltf(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF") || without_mark(bytes).trim_ascii_start().starts_with(b"{")
}

fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The `u32` at a place.
fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let word: [u8; 4] = bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(word)).ok()
}

impl Container {
    /// A GLB container with a binary chunk.
    pub(super) fn glb(binary: Vec<u8>) -> Container {
        Container {
            is_glb: true,
            binary: Some(binary),
            others: Vec::new(),
        }
    }

    /// Takes a file apart, container and document; or says what is wrong with it.
    pub(super) fn split(bytes: &[u8]) -> Result<(Container, Json), String> {
        let mut container = Container {
            is_glb: bytes.starts_with(b"glTF"),
            binary: None,
            others: Vec::new(),
        };
        let mut text = bytes;
        if container.is_glb {
            let cut_off = || "it is cut off".to_owned();
            let end = word(bytes, 8).filter(|end| *end <= bytes.len()).ok_or_else(cut_off)?;
            let mut at = 12;
            text = &[];
            while at < end {
                let size = word(bytes, at).ok_or_else(cut_off)?;
                let chunk = bytes[..end].get(at + 8..).and_then(|rest| rest.get(..size));
                let chunk = chunk.ok_or_else(cut_off)?;
                match &bytes[at + 4..at + 8] {
                    JSON_CHUNK if text.is_empty() => text = chunk,
                    BINARY_CHUNK if container.binary.is_none() => container.binary = Some(chunk.to_vec()),
                    _ => container.others.extend_from_slice(&bytes[at..at + 8 + size]),
                }
                at += 8 + size;
            }
        }
        let document: Json = serde_json::from_slice(without_mark(text)).map_err(|error| error.to_string())?;
        if !document.is_object() {
            return Err("its JSON is not an object".to_owned());
        }
        // The chunk may have up to three bytes more than its buffer.
        let claimed = document["buffers"][0]["byteLength"].as_u64().unwrap_or(u64::MAX);
        if let Some(binary) = &mut container.binary {
            binary.truncate(usize::try_from(claimed).unwrap_or(usize::MAX));
        }
        Ok((container, document))
    }

    /// Whether it is a `.glb` file.
    pub(super) fn is_glb(&self) -> bool {
        self.is_glb
    }

    /// The binary chunk.
    #[cfg(test)]
    pub(super) fn binary(&self) -> &[u8] {
        self.binary.as_deref().unwrap_or_default()
    }

    /// Appends bytes to the binary chunk: their buffer view; none where there is no such chunk.
    pub(super) fn put(&mut self, bytes: &[u8]) -> Option<Json> {
        let binary = self.binary.as_mut()?;
        binary.resize(binary.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len() });
        binary.extend_from_slice(bytes);
        Some(view)
    }

    /// Cuts out of the binary chunk what only the `dead` buffer views held. All else keeps its order and alignment.
    pub(super) fn forget(&mut self, document: &mut Json, dead: &[Json]) {
        let Some(binary) = &mut self.binary else { return };
        let views = document["bufferViews"].as_array_mut();
        let Some(views) = views.filter(|views| views.iter().all(|view| view.get("extensions").is_none())) else {
            // An extension may keep places in the buffer of its own.
            return;
        };
        let live: Vec<[usize; 2]> = views.iter().filter_map(range).collect();
        let mut cuts: Vec<[usize; 2]> = dead
            .iter()
            .filter_map(range)
            .filter(|[from, to]| *to <= binary.len() && live.iter().all(|[start, end]| to <= start || end <= from))
            .map(|[from, to]| [from, from + (to - from) / ALIGNMENT * ALIGNMENT])
            .collect();
        cuts.sort_unstable();
        cuts.dedup_by(|next, kept| next[0] < kept[1]);
        let moved = |at: usize| -> usize {
            cuts.iter()
                .filter(|[_, to]| *to <= at)
                .map(|[from, to]| to - from)
                .sum()
        };
        for view in views.iter_mut() {
            if let Some([at, _]) = range(view)
                && moved(at) > 0
            {
                view["byteOffset"] = json!(at - moved(at));
            }
        }
        for [from, to] in cuts.into_iter().rev() {
            binary.drain(from..to);
        }
    }

    /// The file.
    pub(super) fn join(self, document: &mut Json) -> Vec<u8> {
        if let Some(binary) = &self.binary {
            document["buffers"][0]["byteLength"] = json!(binary.len());
        }
        if !self.is_glb {
            return format!("{document:#}\n").into_bytes();
        }
        let mut file = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        chunk(&mut file, JSON_CHUNK, document.to_string().into_bytes(), b' ');
        if let Some(binary) = self.binary {
            chunk(&mut file, BINARY_CHUNK, binary, 0);
        }
        file.extend_from_slice(&self.others);
        let length = file.len() as u32;
        file[8..12].copy_from_slice(&length.to_le_bytes());
        file
    }
}

/// First byte of a view of buffer 0, and the one behind its last.
fn range(view: &Json) -> Option<[usize; 2]> {
    let number = |key: &str| view.get(key).and_then(Json::as_u64);
    if number("buffer") != Some(0) {
        return None;
    }
    let from = usize::try_from(number("byteOffset").unwrap_or(0)).ok()?;
    Some([from, from.checked_add(usize::try_from(number("byteLength")?).ok()?)?])
}

fn chunk(file: &mut Vec<u8>, kind: &[u8], mut bytes: Vec<u8>, filler: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), filler);
    file.extend_from_slice(&(bytes.len() as u32).to_le_bytes());
    file.extend_from_slice(kind);
    file.extend_from_slice(&bytes);
}
