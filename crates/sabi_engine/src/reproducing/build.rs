//! The program that makes maps.

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::inputs::digest;

/// The program that made a set of maps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Build {
    /// Version of Sabi.
    pub version: String,
    /// Operating system and processor, `linux-x86_64`.
    pub system: String,
    /// BLAKE3 of the program's file, hexadecimal; `None` where the system does not let it be read.
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
