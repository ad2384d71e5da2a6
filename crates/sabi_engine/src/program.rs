//! The program that makes maps, and the hashes of files that identify it.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::OnceLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bytes that are hashed at a time, on all cores.
const PART_BYTES: usize = 1 << 20;

/// The program that made a set of maps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Build {
    /// Version of Sabi.
    pub version: String,
    /// Operating system and processor, `linux-x86_64`.
    pub system: String,
    /// BLAKE3 of the program's file, hexadecimal; `None` if the system does not allow reading it.
    pub blake3: Option<String>,
}

impl Build {
    /// The program that runs.
    pub fn current() -> &'static Build {
        static CURRENT: OnceLock<Build> = OnceLock::new();
        CURRENT.get_or_init(|| Build {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            system: format!("{}-{}", std::env::consts::OS, std::env::consts::ARCH),
            blake3: std::env::current_exe()
                .ok()
                .and_then(|file| digest(&file))
                .map(|(_, blake3)| blake3),
        })
    }
}

/// Returns length and BLAKE3 of a file's bytes; `None` if it is not a plain file that can be read.
pub fn digest(path: &Path) -> Option<(u64, String)> {
    let read = |mut file: File| -> io::Result<(u64, String)> {
        let mut hasher = blake3::Hasher::new();
        let mut part = vec![0; PART_BYTES];
        loop {
            match file.read(&mut part)? {
                0 => return Ok((hasher.count(), hasher.finalize().to_hex().to_string())),
                read => hasher.update_rayon(&part[..read]),
            };
        }
    };
    // Opening a pipe or a device could wait forever.
    let is_plain = path.metadata().is_ok_and(|found| found.is_file());
    is_plain.then(|| File::open(path).and_then(read).ok()).flatten()
}
