//! The bytes behind a glTF document, and the triangles in them.

use std::path::Path;

use data_url::DataUrl;
use glamx::Vec3;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::{Accessor, Buffer, Gltf, Primitive, Semantic};
use percent_encoding::percent_decode_str;

use super::{MeshErrorCause, file};
use crate::mesh::Mesh;

/// What indices may be stored as.
const INDEX_TYPES: [DataType; 3] = [DataType::U8, DataType::U16, DataType::U32];

/// All buffers of a document, in its order.
pub(super) struct Buffers(Vec<Vec<u8>>);

impl Buffers {
    /// Takes the buffers from the binary part, from data URIs, and from files in `folder`.
    pub fn load(gltf: &Gltf, folder: &Path) -> Result<Self, MeshErrorCause> {
        let load = |buffer: Buffer| {
            let what = format!("buffer {}", buffer.index());
            let data = match buffer.source() {
                Source::Bin => gltf.blob.clone().ok_or("there is no binary part".to_owned()),
                Source::Uri(uri) if uri.starts_with("data:") => decode(uri),
                Source::Uri(uri) => {
                    let name = percent_decode_str(uri).decode_utf8_lossy();
                    Ok(file::bytes(&folder.join(&*name))?)
                }
            };
            let data =
                data.map_err(|problem| MeshErrorCause::Format(format!("{what}: {problem}")))?;
            MeshErrorCause::check_length(&what, buffer.length() as u64, data.len() as u64)?;
            Ok(data)
        };
        gltf.buffers().map(load).collect::<Result<_, _>>().map(Self)
    }

    /// The triangles of a primitive in its own frame, none where it draws points or lines.
    pub fn primitive(&self, primitive: &Primitive) -> Result<Mesh, String> {
        let positions = primitive.get(&Semantic::Positions).ok_or("it has no positions")?;
        self.check(&positions, &[DataType::F32], Dimensions::Vec3)?;
        let reader = primitive.reader(|buffer| self.0.get(buffer.index()).map(Vec::as_slice));
        let vertices: Vec<Vec3> = reader
            .read_positions()
            .ok_or("its positions cannot be read")?
            .map(Vec3::from_array)
            .collect();
        let indices: Vec<u32> = match primitive.indices() {
            None => (0..vertices.len() as u32).collect(),
            Some(accessor) => {
                self.check(&accessor, &INDEX_TYPES, Dimensions::Scalar)?;
                let indices = reader.read_indices().ok_or("its indices cannot be read")?;
                indices.into_u32().collect()
            }
        };
        let triangles = triangles(&indices, primitive.mode());
        Ok(Mesh::new("primitive", vertices, triangles))
    }

    /// Checks what `gltf` takes on trust: that an accessor is of the kind wanted, and that its
    /// bytes exist. The sums are too wide to overflow.
    fn check(
        &self,
        accessor: &Accessor,
        types: &[DataType],
        dimensions: Dimensions,
    ) -> Result<(), String> {
        let index = accessor.index();
        if !types.contains(&accessor.data_type()) || accessor.dimensions() != dimensions {
            return Err(format!(
                "accessor {index} holds {:?} of {:?} where {dimensions:?} of {types:?} belong",
                accessor.dimensions(),
                accessor.data_type(),
            ));
        }
        if accessor.sparse().is_some() {
            return Err(format!("accessor {index} is sparse, which is not supported"));
        }
        let view = accessor.view().ok_or_else(|| format!("accessor {index} has no buffer view"))?;
        let [count, size, offset] =
            [accessor.count(), accessor.size(), accessor.offset()].map(|n| n as u128);
        let [start, length] = [view.offset(), view.length()].map(|n| n as u128);
        let stride = view.stride().map_or(size, |stride| stride as u128);
        let end = offset + stride * count.saturating_sub(1) + size;
        let buffer_length = self.0[view.buffer().index()].len() as u128;
        if count == 0 || stride < size || end > length || start + length > buffer_length {
            return Err(format!(
                "accessor {index} asks for {count} items in {end} bytes of a view of {length}, \
                 in a buffer of {buffer_length}"
            ));
        }
        Ok(())
    }
}

/// The bytes of a data URI.
fn decode(uri: &str) -> Result<Vec<u8>, String> {
    let url = DataUrl::process(uri).map_err(|error| format!("{error:?}"))?;
    let (data, _) = url.decode_to_vec().map_err(|error| error.to_string())?;
    Ok(data)
}

/// Triangles from what a primitive draws, in the order of the standard. Corners left over at the
/// end are dropped, as the standard asks.
fn triangles(indices: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::Triangles => indices.as_chunks().0.to_vec(),
        Mode::TriangleStrip => (0..indices.len().saturating_sub(2))
            .map(|i| [i, i + 1 + i % 2, i + 2 - i % 2].map(|k| indices[k]))
            .collect(),
        Mode::TriangleFan => {
            (2..indices.len()).map(|i| [i - 1, i, 0].map(|k| indices[k])).collect()
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}
