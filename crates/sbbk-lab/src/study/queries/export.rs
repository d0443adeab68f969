//! Meshes, poses, times and answers as files, for programs that ask other libraries the same.

use std::error::Error;
use std::fmt::Write;
use std::fs::create_dir_all;
use std::path::Path;

use super::ask::Query;
use super::{Asked, QueriedMesh, QueriesPlan, SIZE};
use crate::mesh::Mesh;
use crate::report::{Results, write_file};

/// Writes `DIR/<mesh>.obj` and `DIR/queries.csv`: for each pose of each row the query, the place,
/// the pose of mesh 2 in the frame of mesh 1, the least times of stock and SBBK over all poses of
/// the row (µs), and their answers.
///
/// Errors: a file cannot be written.
pub fn export(plan: &QueriesPlan, results: &Results, folder: &Path) -> Result<(), Box<dyn Error>> {
    create_dir_all(folder)?;
    let header = "mesh,query,place,tx,ty,tz,qx,qy,qz,qw,stock_us,sbbk_us,stock,sbbk\n";
    let mut table = header.to_owned();
    for QueriedMesh { mesh, pose_count } in &plan.meshes {
        let name = format!("{}-{}.obj", mesh.name.replace(' ', "-"), mesh.triangle_count());
        let text = obj(&mesh.clone().centred().scaled_to(SIZE))?;
        write_file(&folder.join(&name), text)?;
        let asked = Asked::new(mesh);
        let questions = Query::ALL
            .into_iter()
            .flat_map(|query| query.distances().iter().map(move |&distance| (query, distance)));
        for (query, distance) in questions {
            let row = |backend: &str| {
                results.rows.iter().find(|row| {
                    row.is("backend", backend)
                        && row.count("triangle_count") == mesh.triangle_count() as u64
                        && row.is("query", query)
                        && row.is("place", distance)
                })
            };
            let (Some(stock), Some(sbbk)) = (row("stock"), row("sbbk")) else { continue };
            let times = [stock, sbbk].map(|row| row.number("time.min"));
            let places = asked.places(distance, *pose_count);
            let answers =
                asked.contest.dispatchers.each_ref().map(|d| asked.ask(query, d, &places));
            for (index, placed) in places.iter().enumerate() {
                let pose = placed.pos12;
                let pose = [&pose.translation.to_array()[..], &pose.rotation.to_array()].concat();
                let pose: Vec<String> = pose.iter().map(f32::to_string).collect();
                let [stock, sbbk] = answers.each_ref().map(|answers| answers[index].number());
                write!(table, "{name},{query},{distance},{},", pose.join(","))?;
                writeln!(table, "{},{},{stock},{sbbk}", times[0], times[1])?;
            }
        }
    }
    Ok(write_file(&folder.join("queries.csv"), table)?)
}

fn obj(mesh: &Mesh) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for v in &mesh.vertices {
        writeln!(text, "v {} {} {}", v.x, v.y, v.z)?;
    }
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|i| i + 1)) {
        writeln!(text, "f {a} {b} {c}")?;
    }
    Ok(text)
}
