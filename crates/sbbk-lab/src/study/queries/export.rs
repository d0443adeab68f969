//! Meshes, poses, times and answers as files, for programs that ask other libraries the same.

use std::fs::{File, create_dir_all};
use std::io::{BufWriter, Error, Write};
use std::path::Path;

use super::plan::{QueriesPlan, SIZE};
use super::report::{Asked, Queries};
use crate::mesh::Mesh;

/// Writes `DIR/<mesh>.obj` and `DIR/queries.csv`: for each pose of each row the query, the place, the pose of mesh 2 in
/// the frame of mesh 1, the least times of stock and SBBK over all poses of the row (µs), and their answers.
///
/// Errors: a file cannot be written.
pub fn export(plan: &QueriesPlan, queries: &Queries, folder: &Path) -> Result<(), Error> {
    create_dir_all(folder)?;
    let mut table = BufWriter::new(File::create(folder.join("queries.csv"))?);
    writeln!(table, "mesh,query,place,tx,ty,tz,qx,qy,qz,qw,stock_us,sbbk_us,stock,sbbk")?;
    for (mesh, pose_count) in &plan.meshes {
        let sized = mesh.clone().centred().scaled_to(SIZE);
        write_obj(&sized, &folder.join(file_name(mesh)))?;
        let asked = Asked::new(sized.shared_shape().map_err(Error::other)?);
        for row in queries.rows.iter().filter(|row| row.triangle_count == mesh.triangle_count()) {
            let [stock, sbbk] = &row.sides;
            for (i, placed) in asked.poses(row.place, *pose_count).iter().enumerate() {
                let (t, q) = (placed.pos12.translation, placed.pos12.rotation);
                writeln!(
                    table,
                    "{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                    file_name(mesh),
                    row.query,
                    row.place,
                    t.x,
                    t.y,
                    t.z,
                    q.x,
                    q.y,
                    q.z,
                    q.w,
                    stock.time.min,
                    sbbk.time.min,
                    stock.answers[i].number(),
                    sbbk.answers[i].number(),
                )?;
            }
        }
    }
    table.flush()
}

fn file_name(mesh: &Mesh) -> String {
    format!("{}-{}.obj", mesh.name.replace(' ', "-"), mesh.triangle_count())
}

fn write_obj(mesh: &Mesh, path: &Path) -> Result<(), Error> {
    let mut file = BufWriter::new(File::create(path)?);
    for v in &mesh.vertices {
        writeln!(file, "v {} {} {}", v.x, v.y, v.z)?;
    }
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|i| i + 1)) {
        writeln!(file, "f {a} {b} {c}")?;
    }
    file.flush()
}
