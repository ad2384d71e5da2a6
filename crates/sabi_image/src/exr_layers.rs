//! Layers of an OpenEXR file: channels of one part that have the same prefix.

use std::collections::BTreeMap;

/// Last parts of the names of layers that contain the finished image, as renderers write them, in lower case.
const FINISHED: [&str; 9] = [
    "beauty",
    "combined",
    "rgba",
    "rgb",
    "composite",
    "final",
    "main",
    "color",
    "image",
];

/// Start of the names of layers with hashes (Cryptomatte specification 1.2), which are not images, in lower case.
const HASHES: &str = "crypto";

/// Channels of a part of a file, in the file's order, and the name of the part, if it has one.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExrPart {
    pub(crate) name: Option<String>,
    pub(crate) channels: Vec<String>,
}

/// Channels that form an image, as indices into the channels of a part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ExrLayer {
    /// Name as artists know it, such as `beauty` or `ViewLayer.Combined`. If the channels have no prefix and the part has
    /// no name, the name is that of the channels, such as `RGBA`.
    pub(crate) name: String,
    /// Number of the part.
    pub(crate) part: usize,
    /// Channels of the image in order. `None` stands for a channel that is 0 everywhere.
    pub(crate) channels: Vec<Option<usize>>,
    rank: Rank,
}

/// Order in which layers are chosen if none is requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    /// Color without a prefix.
    Plain,
    /// Color of a layer with the name of a finished image.
    Finished,
    Color,
    Luminance,
    /// Positions, normals, motion.
    Vector,
    Single,
    Hashes,
}

/// Lists the layers of a file that form an image, the default layer first.
pub(crate) fn layers(parts: &[ExrPart]) -> Vec<ExrLayer> {
    let mut layers: Vec<ExrLayer> = Vec::new();
    for (number, part) in parts.iter().enumerate() {
        // Prefixes in the order of the file, which is alphabetical.
        let mut groups: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (index, channel) in part.channels.iter().enumerate() {
            let prefix = channel.rsplit_once('.').map_or("", |(prefix, _)| prefix);
            groups.entry(prefix).or_default().push(index);
        }
        for (prefix, indices) in groups {
            layers.extend(layers_of_group(number, part, prefix, &indices));
        }
    }
    // The sort is stable: layers of the same rank keep the order of the file.
    layers.sort_by_key(|layer| layer.rank);
    layers
}

/// Returns the layers of the channels with one prefix: an image, and each remaining channel as a layer of its own.
fn layers_of_group(number: usize, part: &ExrPart, prefix: &str, indices: &[usize]) -> Vec<ExrLayer> {
    let last_of = |index: usize| {
        let name = part.channels[index].as_str();
        name.rsplit_once('.').map_or(name, |(_, last)| last)
    };
    let find = |names: &[&str]| {
        let is_one = |index: &&usize| names.iter().any(|name| name.eq_ignore_ascii_case(last_of(**index)));
        indices.iter().find(is_one).copied()
    };
    let (red, green, blue) = (find(&["R", "red"]), find(&["G", "green"]), find(&["B", "blue"]));
    let alpha = find(&["A", "alpha"]);
    let (x, y, z) = (find(&["X"]), find(&["Y"]), find(&["Z"]));
    let own_name = part.name.as_deref().unwrap_or_default(); // A part without a name contributes nothing to the names of its layers.
    let name = if prefix.is_empty() { own_name } else { prefix };
    let is_finished = |name: &str| {
        let last = name.rsplit(['.', '/']).next().unwrap_or(name);
        FINISHED.iter().any(|known| known.eq_ignore_ascii_case(last))
    };
    let is_hash = name.to_ascii_lowercase().starts_with(HASHES);
    let (rank, mut channels) = match (red, green, blue) {
        // Two of the three colors, as in an optical flow; the third does not exist.
        (Some(_), Some(_), _) | (Some(_), _, Some(_)) | (_, Some(_), Some(_)) => {
            let rank = match name {
                _ if is_hash => Rank::Hashes,
                "" => Rank::Plain,
                name if is_finished(name) => Rank::Finished,
                _ => Rank::Color,
            };
            (rank, vec![red, green, blue])
        }
        _ => match (x, y, z) {
            (Some(_), Some(_), _) => (Rank::Vector, vec![x, y, z]),
            (None, Some(luminance), _) => (Rank::Luminance, vec![Some(luminance)]),
            _ => {
                // A single channel with any name, such as depth, or the single color of a mask.
                let lone = red
                    .or(green)
                    .or(blue)
                    .or_else(|| indices.iter().find(|index| Some(**index) != alpha).copied());
                let rank = if is_hash { Rank::Hashes } else { Rank::Single };
                (rank, vec![Some(lone.or(alpha).unwrap_or(indices[0]))])
            }
        },
    };
    let is_alpha_free = alpha.is_some_and(|alpha| !channels.contains(&Some(alpha)));
    if is_alpha_free && rank != Rank::Vector {
        channels.push(alpha);
    }
    let left = indices.iter().filter(|index| !channels.contains(&Some(**index)));
    let alone = left.map(|index| ExrLayer {
        name: match name {
            "" => part.channels[*index].clone(),
            name => format!("{name}.{}", last_of(*index)),
        },
        part: number,
        channels: vec![Some(*index)],
        rank: if is_hash { Rank::Hashes } else { Rank::Single },
    });
    let alone: Vec<ExrLayer> = alone.collect();
    let own = channels.iter().flatten().map(|index| part.channels[*index].as_str());
    let picture = ExrLayer {
        name: if name.is_empty() {
            own.collect()
        } else {
            name.to_owned()
        },
        part: number,
        channels,
        rank,
    };
    std::iter::once(picture).chain(alone).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(name: Option<&str>, channels: &[&str]) -> ExrPart {
        ExrPart {
            name: name.map(str::to_owned),
            channels: channels.iter().map(ToString::to_string).collect(),
        }
    }

    /// Returns name and channels of each layer, with `-` for a channel that the file does not have.
    fn listed(parts: &[ExrPart]) -> Vec<String> {
        let of_layer = |layer: ExrLayer| {
            let channels = layer.channels.iter().map(|channel| match channel {
                Some(index) => parts[layer.part].channels[*index].clone(),
                None => "-".to_owned(),
            });
            format!("{}: {}", layer.name, channels.collect::<Vec<_>>().join(" "))
        };
        layers(parts).into_iter().map(of_layer).collect()
    }

    #[test]
    fn components_come_from_one_layer_and_the_finished_image_comes_first() {
        let cases: [(&[&str], &[&str]); 9] = [
            (&["A", "B", "G", "R"], &["RGBA: R G B A"]),
            (
                &["beauty.B", "beauty.G", "beauty.R", "mask.R"],
                &["beauty: beauty.R beauty.G beauty.B", "mask: mask.R"],
            ),
            (
                &[
                    "albedo.B", "albedo.G", "albedo.R", "rgba.A", "rgba.B", "rgba.G", "rgba.R",
                ],
                &[
                    "rgba: rgba.R rgba.G rgba.B rgba.A",
                    "albedo: albedo.R albedo.G albedo.B",
                ],
            ),
            (
                &["View.Combined.B", "View.Combined.G", "View.Combined.R", "View.Depth.Z"],
                &[
                    "View.Combined: View.Combined.R View.Combined.G View.Combined.B",
                    "View.Depth: View.Depth.Z",
                ],
            ),
            // A channel without a prefix does not complete the colors of a layer.
            (
                &["R", "diffuse.B", "diffuse.G"],
                &["diffuse: - diffuse.G diffuse.B", "R: R"],
            ),
            (&["N.X", "N.Y", "N.Z"], &["N: N.X N.Y N.Z"]),
            (&["A", "B", "G", "R", "Z"], &["RGBA: R G B A", "Z: Z"]),
            (&["A", "Y", "Z"], &["YA: Y A", "Z: Z"]),
            (
                &["CryptoObject00.B", "CryptoObject00.G", "CryptoObject00.R", "depth.Z"],
                &[
                    "depth: depth.Z",
                    "CryptoObject00: CryptoObject00.R CryptoObject00.G CryptoObject00.B",
                ],
            ),
        ];
        for (channels, expected) in cases {
            assert_eq!(listed(&[part(None, channels)]), expected, "{channels:?}");
        }
    }

    #[test]
    fn parts_name_the_layers_of_channels_without_a_prefix() {
        let parts = [
            part(Some("depth"), &["Z"]),
            part(Some("diffuse"), &["B", "G", "R"]),
            part(Some("beauty"), &["B", "G", "R"]),
        ];
        assert_eq!(listed(&parts), ["beauty: R G B", "diffuse: R G B", "depth: Z"]);
    }
}
