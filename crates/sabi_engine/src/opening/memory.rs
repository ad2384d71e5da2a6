//! Memory that a model and its pictures may take.

use std::fs;
use std::sync::OnceLock;

/// Memory of a model where that of the machine is not known, bytes.
const UNKNOWN: u64 = 8 << 30;
/// Least memory of a model by default, bytes.
const LEAST: u64 = 1 << 30;

/// Returns the memory that a model may take by default, bytes: half of what the machine has, or what the group of this process
/// may take of it.
pub fn default_memory_bytes() -> u64 {
    static BYTES: OnceLock<u64> = OnceLock::new();
    *BYTES.get_or_init(|| {
        // Linux alone says it in files; other systems would need calls of their own.
        let machine = fs::read_to_string("/proc/meminfo")
            .ok()
            .and_then(|text| total_of(&text));
        let group = fs::read_to_string("/sys/fs/cgroup/memory.max").ok();
        let group = group.and_then(|text| text.trim().parse().ok());
        share_of([machine, group].into_iter().flatten().min())
    })
}

/// Half of a machine's memory, bytes.
fn share_of(machine: Option<u64>) -> u64 {
    machine.map_or(UNKNOWN, |bytes| (bytes / 2).max(LEAST))
}

/// Total memory in the text of `/proc/meminfo`, bytes.
fn total_of(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::{LEAST, UNKNOWN, share_of, total_of};

    #[test]
    fn a_model_takes_half_of_the_memory() {
        let text = "MemTotal:       16384000 kB\nMemFree:         1000 kB\n";
        assert_eq!(total_of(text), Some(16_384_000 << 10));
        assert_eq!(total_of("MemFree: 1 kB\n"), None);
        assert_eq!(share_of(Some(16 << 30)), 8 << 30);
        assert_eq!(share_of(Some(1 << 20)), LEAST);
        assert_eq!(share_of(None), UNKNOWN);
    }
}
