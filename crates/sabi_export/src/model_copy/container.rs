//! Container of a glTF document: a JSON file, or a GLB file with a binary chunk.

use sabi_surface::load::gltf_json;
use serde_json::{Value as Json, json};

/// Granularity of cuts. It is a multiple of every element size of glTF, so that the bytes after a cut stay aligned.
const ALIGNMENT: usize = 16;
/// Chunks of a GLB file are padded to a multiple of this.
const ALIGNMENT_OF_CHUNKS: usize = 4;
/// Extensions of packed buffer views. They refer to packed bytes in the same way as a view refers to its own bytes.
pub(super) const PACKED: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
const JSON_CHUNK: &[u8] = b"JSON";
const BINARY_CHUNK: &[u8] = b"BIN\0";

/// A container without its JSON.
#[derive(Debug)]
pub(super) struct Container {
    is_glb: bool,
    /// The binary chunk if it is buffer 0; `None` if the file has none, or if its first buffer is a separate file.
    binary: Option<Vec<u8>>,
    /// Chunks of other kinds, headers included.
    others: Vec<u8>,
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

    /// Splits a file into container and document; the error says what is wrong with it.
    pub(super) fn split(bytes: &[u8]) -> Result<(Container, Json), String> {
        let mut container = Container {
            is_glb: bytes.starts_with(b"glTF"),
            binary: None,
            others: Vec::new(),
        };
        let mut text = bytes;
        let mut binary = None;
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
                    BINARY_CHUNK if binary.is_none() => binary = Some(chunk),
                    _ => container.others.extend_from_slice(&bytes[at..at + 8 + size]),
                }
                at += 8 + size;
            }
        }
        let document = gltf_json(text).map_err(|error| error.to_string())?;
        if !document.is_object() {
            return Err("its JSON is not an object".to_owned());
        }
        if let Some(chunk) = binary {
            container.take_binary(chunk, &document["buffers"][0]);
        }
        Ok((container, document))
    }

    /// Uses the binary chunk as the first buffer, or keeps it as a chunk of unknown kind.
    fn take_binary(&mut self, chunk: &[u8], buffer: &Json) {
        if !buffer.is_object() || !buffer["uri"].is_null() {
            // The binary chunk directly follows the JSON.
            let size = (chunk.len() as u32).to_le_bytes();
            self.others.splice(0..0, [&size, BINARY_CHUNK, chunk].concat());
            return;
        }
        // Up to three zeros pad the chunk. A buffer with a smaller declared length is invalid, and views may extend beyond that length.
        let claimed = buffer["byteLength"]
            .as_u64()
            .and_then(|size| usize::try_from(size).ok());
        let is_filler = |filler: &[u8]| filler.len() < ALIGNMENT_OF_CHUNKS && filler.iter().all(|byte| *byte == 0);
        let parts = claimed.and_then(|size| chunk.split_at_checked(size));
        let held = parts
            .filter(|(_, filler)| is_filler(filler))
            .map_or(chunk, |(held, _)| held);
        self.binary = Some(held.to_vec());
    }

    /// Returns true for a `.glb` file.
    pub(super) fn is_glb(&self) -> bool {
        self.is_glb
    }

    /// The binary chunk where it is buffer 0.
    pub(super) fn binary_chunk(&self) -> Option<&[u8]> {
        self.binary.as_deref()
    }

    /// The binary chunk.
    #[cfg(test)]
    pub(super) fn binary(&self) -> &[u8] {
        // A file without a binary chunk has no bytes.
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

    /// Uses `bytes` as the binary chunk. Returns false if the file is not a `.glb`, or already has such a chunk.
    pub(super) fn adopt(&mut self, bytes: Vec<u8>) -> bool {
        let has_chunk = self.binary.is_some() || self.others.get(4..8) == Some(BINARY_CHUNK);
        if !self.is_glb || has_chunk {
            return false;
        }
        self.binary = Some(bytes);
        true
    }

    /// Removes the bytes from the binary chunk to which only the `dead` buffer views refer. Other bytes keep their order and alignment.
    pub(super) fn forget(&mut self, document: &mut Json, dead: &[Json]) {
        let Some(binary) = &mut self.binary else { return };
        let views = document["bufferViews"].as_array_mut();
        let Some(views) = views.filter(|views| views.iter().all(is_understood)) else {
            return;
        };
        let mut cuts = cuts(views.iter().flat_map(ranges).collect(), dead);
        cuts.retain(|[_, to]| *to <= binary.len());
        // For each cut, the total of removed bytes up to its end.
        let mut sum = 0;
        let mut cut_before = vec![0];
        for [from, to] in &cuts {
            sum += to - from;
            cut_before.push(sum);
        }
        let moved = |at: usize| cut_before[cuts.partition_point(|[_, to]| *to <= at)];
        let shift = |place: &mut Json| {
            if let Some([at, _]) = range(place)
                && moved(at) > 0
            {
                place["byteOffset"] = json!(at - moved(at));
            }
        };
        for view in views.iter_mut() {
            shift(view);
            for name in PACKED {
                if let Some(packed) = view.get_mut("extensions").and_then(|all| all.get_mut(name)) {
                    shift(packed);
                }
            }
        }
        let mut kept = 0;
        let mut from = 0;
        for [start, end] in cuts.into_iter().chain([[binary.len(); 2]]) {
            binary.copy_within(from..start, kept);
            kept += start - from;
            from = end;
        }
        binary.truncate(kept);
    }

    /// Returns the file; or, as the error, its size if that is too large for a GLB file.
    pub(super) fn join(self, document: &mut Json) -> Result<Vec<u8>, u64> {
        if let Some(binary) = &self.binary {
            document["buffers"][0]["byteLength"] = json!(binary.len());
        }
        if !self.is_glb {
            return Ok(format!("{document:#}\n").into_bytes());
        }
        let text = document.to_string().into_bytes();
        let size = |chunk: &[u8]| 8 + chunk.len().next_multiple_of(ALIGNMENT_OF_CHUNKS) as u64;
        let total = 12 + size(&text) + self.binary.as_deref().map_or(0, size) + self.others.len() as u64;
        let mut file = b"glTF\x02\0\0\0".to_vec();
        file.extend_from_slice(&length(total)?);
        chunk(&mut file, JSON_CHUNK, text, b' ')?;
        if let Some(binary) = self.binary {
            chunk(&mut file, BINARY_CHUNK, binary, 0)?;
        }
        file.extend_from_slice(&self.others);
        Ok(file)
    }
}

/// Returns the ranges that only the `dead` buffer views refer to, in multiples of [`ALIGNMENT`]: rising and disjoint.
fn cuts(mut live: Vec<[usize; 2]>, dead: &[Json]) -> Vec<[usize; 2]> {
    live.sort_unstable();
    // Overlapping ranges are joined, so that starts and ends are ascending.
    live.dedup_by(|next, kept| {
        let joins = next[0] <= kept[1];
        kept[1] = if joins { kept[1].max(next[1]) } else { kept[1] };
        joins
    });
    let is_dead = |[from, to]: &[usize; 2]| {
        let behind = live.partition_point(|[_, end]| end <= from);
        live.get(behind).is_none_or(|[start, _]| to <= start)
    };
    let whole = |[from, to]: [usize; 2]| [from, from + (to - from) / ALIGNMENT * ALIGNMENT];
    let dead = dead.iter().flat_map(ranges).filter(is_dead);
    let mut cuts: Vec<[usize; 2]> = dead.map(whole).filter(|[from, to]| from < to).collect();
    cuts.sort_unstable();
    cuts.dedup_by(|next, kept| next[0] < kept[1]);
    cuts
}

/// Returns false for a buffer view with an extension that may refer to ranges of the buffer in an unknown way.
fn is_understood(view: &Json) -> bool {
    let extensions = view.get("extensions").and_then(Json::as_object);
    let mut names = extensions.into_iter().flat_map(|extensions| extensions.keys());
    names.all(|name| PACKED.contains(&name.as_str()))
}

/// Ranges of buffer 0 that a view refers to: its own and that of its packed bytes.
fn ranges(view: &Json) -> impl Iterator<Item = [usize; 2]> {
    let packed = PACKED.iter().filter_map(|name| view.get("extensions")?.get(name));
    packed.chain([view]).filter_map(range)
}

/// Returns the first byte of a view of buffer 0, and the one after its last.
fn range(view: &Json) -> Option<[usize; 2]> {
    let number = |key: &str| view.get(key).and_then(Json::as_u64);
    if number("buffer") != Some(0) {
        return None;
    }
    // 0 is glTF's default.
    let from = usize::try_from(number("byteOffset").unwrap_or(0)).ok()?;
    Some([from, from.checked_add(usize::try_from(number("byteLength")?).ok()?)?])
}

/// Returns a length as GLB files store it; the length itself is the error where it does not fit.
fn length(bytes: u64) -> Result<[u8; 4], u64> {
    u32::try_from(bytes).map(u32::to_le_bytes).map_err(|_| bytes)
}

fn chunk(file: &mut Vec<u8>, kind: &[u8], mut bytes: Vec<u8>, filler: u8) -> Result<(), u64> {
    bytes.resize(bytes.len().next_multiple_of(ALIGNMENT_OF_CHUNKS), filler);
    file.extend_from_slice(&length(bytes.len() as u64)?);
    file.extend_from_slice(kind);
    file.extend_from_slice(&bytes);
    Ok(())
}

#[cfg(test)]
pub(super) mod tests;
