//! The pile of heads in several engines, each a program of its own. All read the same file and
//! write one file of a run; one judge reads these.

use crate::prelude::*;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::ops::Range;

use glamx::DQuat;
use rapier3d::parry::mass_properties::MassProperties;

use super::Column;
use super::depth::Depths;
use super::figures::greatest_rise;
use super::heaps::{FLOOR, above_floor};
use super::kit::{Form, Kit};

/// Ten seconds, and the steps of them that are timed: in motion, and at rest.
const STEPS: usize = 600;
const MOVING: Range<usize> = 60..180;
const RESTING: Range<usize> = 540..600;
/// Rapier's defaults: seconds a step, gravity in units/s², and the friction of each contact.
const TIME_STEP: f32 = 1.0 / 60.0;
const GRAVITY: f32 = 9.81;
const FRICTION: f32 = 0.5;
/// Depth in units above which a pair counts as inside each other: ten times the depth that Rapier
/// allows.
const INSIDE: f64 = 0.01;
/// Numbers of a step in the file of a run: milliseconds, solver points, peak memory of the process
/// in MiB, and peak memory above an empty world.
const HEADER: usize = 4;
/// Numbers of a head: place, orientation (x, y, z, w), velocity, angular velocity.
const STATE: usize = 13;

/// The scene of all engines. The head is in the frame of its principal axes of inertia, with the
/// centre of mass as origin. Contacts have no restitution.
#[derive(Clone, Debug, PartialEq)]
pub struct EnginePile {
    /// Mass of a head.
    pub mass: f32,
    /// Moments of inertia about the axes.
    pub inertia: Vec3,
    /// The head.
    pub mesh: Mesh,
    /// Poses of the heads at the start.
    pub poses: Vec<Pose3>,
    /// Points whose hulls are the convex parts of a head.
    pub parts: Vec<Vec<Vec3>>,
}

impl EnginePile {
    /// A pile of closed heads, with Parry's decomposition of them.
    pub fn new(pile: &MonkeyPile) -> Self {
        let properties = pile.mesh.shape().mass_properties(1.0);
        let axes =
            Pose3::from_parts(properties.local_com, properties.principal_inertia_local_frame);
        let mesh = pile.mesh.clone().posed(&axes.inverse()).named("head");
        let convex = SharedShape::convex_decomposition(&mesh.vertices, &mesh.triangles);
        let parts = convex.as_compound().into_iter().flat_map(|compound| compound.shapes());
        let parts = parts.filter_map(|(_, part)| Some(part.as_convex_polyhedron()?.points()));
        Self {
            mass: properties.mass(),
            inertia: properties.principal_inertia(),
            poses: MonkeyPile { mesh: mesh.clone(), ..pile.clone() }.poses(),
            parts: parts.map(<[Vec3]>::to_vec).collect(),
            mesh,
        }
    }

    /// Writes the scene as numbers in f32, lists after their lengths: time step, gravity, friction,
    /// half extents of the floor, steps, and then this pile.
    ///
    /// Errors: the file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        fn list<const N: usize>(items: impl ExactSizeIterator<Item = [f32; N]>) -> Vec<f32> {
            std::iter::once(items.len() as f32).chain(items.flatten()).collect()
        }
        let poses = self
            .poses
            .iter()
            .map(|Pose3 { translation: t, rotation: r, .. }| [t.x, t.y, t.z, r.x, r.y, r.z, r.w]);
        let mut numbers = [
            vec![TIME_STEP, GRAVITY, FRICTION, FLOOR.x, FLOOR.y, FLOOR.z, STEPS as f32],
            vec![self.mass, self.inertia.x, self.inertia.y, self.inertia.z],
            list(self.mesh.vertices.iter().map(Vec3::to_array)),
            list(self.mesh.triangles.iter().map(|indices| indices.map(|index| index as f32))),
            list(poses),
            vec![self.parts.len() as f32],
        ]
        .concat();
        numbers.extend(self.parts.iter().flat_map(|part| list(part.iter().map(Vec3::to_array))));
        fs::write(path, bytes(&numbers))
    }

    /// Reads a scene.
    ///
    /// Errors: the file cannot be read, or has another format.
    pub fn read(path: &Path) -> io::Result<Self> {
        Self::from_numbers(Numbers(read_numbers(path)?.into_iter()))
            .ok_or_else(|| io::Error::other(format!("{} breaks off", path.display())))
    }

    fn from_numbers(mut numbers: Numbers) -> Option<Self> {
        let [_constants @ .., mass, x, y, z] = numbers.take::<11>()?;
        let vertices = numbers.list(Vec3::from_array)?;
        let triangles = numbers.list(|indices: [f32; 3]| indices.map(|index| index as u32))?;
        let poses = numbers.list(|[x, y, z, i, j, k, w]| {
            Pose3::from_parts(Vec3::new(x, y, z), Quat::from_xyzw(i, j, k, w))
        })?;
        let [count] = numbers.take()?;
        let parts: Option<_> =
            (0..count as usize).map(|_| numbers.list(Vec3::from_array)).collect();
        let mesh = Mesh::new("head", vertices, triangles);
        Some(Self { mass, inertia: Vec3::new(x, y, z), mesh, poses, parts: parts? })
    }

    /// Runs the scene in Rapier and writes the file of the run.
    ///
    /// Errors: the file cannot be written.
    pub fn run(&self, column: Column, path: &Path) -> io::Result<()> {
        let mut file = BufWriter::new(File::create(path)?);
        let kit = Kit::new(column, None);
        kit.world().step();
        let empty = memory("VmRSS");
        let form = Form::parts(self.mesh.clone(), self.parts.iter().cloned());
        let properties = MassProperties::new(Vec3::ZERO, self.mass, self.inertia);
        let collider = kit.collider(&form).mass_properties(properties);
        let mut world = above_floor(&kit, FLOOR, self.poses.iter().copied(), &collider);
        for _ in 0..STEPS {
            let clock = Instant::now();
            world.step();
            let time = 1e3 * clock.elapsed().as_secs_f32();
            let memory = memory("VmHWM");
            let mut numbers = vec![time, solver_points(&world) as f32, memory, memory - empty];
            for body in world.watched.iter().map(|&body| &world.bodies[body]) {
                numbers.extend(body.translation().to_array());
                numbers.extend(body.rotation().to_array());
                numbers.extend([body.linvel(), body.angvel()].map(|v| v.to_array()).concat());
            }
            file.write_all(&bytes(&numbers))?;
        }
        file.flush()
    }

    /// Reads runs of engines, named by their files, and makes a table.
    ///
    /// Errors: a file cannot be read or does not have all steps, or runs of an engine differ.
    pub fn judge(&self, paths: &[PathBuf]) -> io::Result<Results> {
        let mut engines: BTreeMap<String, Vec<Run>> = BTreeMap::new();
        for path in paths {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            engines.entry(name).or_default().push(self.read_run(path)?);
        }
        let mut rows = Vec::new();
        let depths = Depths::new(&self.mesh);
        for (engine, runs) in &engines {
            let is_alike =
                |run: &Run| (0..STEPS).all(|step| run.heads(step).eq(runs[0].heads(step)));
            if !runs.iter().all(is_alike) {
                return Err(io::Error::other(format!("runs of {engine} differ")));
            }
            let figures = self.figures(runs, &depths);
            rows.extend(figures.into_iter().map(|(figure, value)| {
                Row::new("engines", engine).key("figure", figure).with("value", value)
            }));
        }
        Ok(Results::new("engines", rows))
    }

    fn read_run(&self, path: &Path) -> io::Result<Run> {
        let numbers = read_numbers(path)?;
        let step_size = HEADER + STATE * self.poses.len();
        match numbers.len() == STEPS * step_size {
            true => Ok(Run { numbers, step_size }),
            false => Err(io::Error::other(format!(
                "{}: not {STEPS} steps of {step_size} numbers",
                path.display()
            ))),
        }
    }

    /// Figures of an engine.
    fn figures(&self, runs: &[Run], depths: &Depths) -> Vec<(&'static str, f64)> {
        let run = &runs[0];
        let times = |steps: Range<usize>| {
            let least = |step| runs.iter().map(|run| run.header(step)[0]).fold(f64::NAN, f64::min);
            let summary = Summary::of(steps.map(least));
            summary.map_or([f64::NAN; 2], |times| [times.median, times.mean])
        };
        let mean = |steps: Range<usize>, of: &dyn Fn(usize) -> f64| {
            steps.clone().map(of).sum::<f64>() / steps.len() as f64
        };
        let height = |step| run.mean(step, |head| f64::from(head[1]));
        let kinetic = |step| run.mean(step, |head| self.kinetic(head));
        let [moving, resting] = [MOVING, RESTING].map(times);
        let [after_2, after_10] = [119, STEPS - 1].map(|step| self.depths(run, step, depths));
        let [.., process, above] = run.header(STEPS - 1);
        vec![
            ("step in motion, median, ms", moving[0]),
            ("step in motion, mean, ms", moving[1]),
            ("step at rest, median, ms", resting[0]),
            ("step at rest, mean, ms", resting[1]),
            ("points in motion", mean(MOVING, &|step| run.header(step)[1])),
            ("points at rest", mean(RESTING, &|step| run.header(step)[1])),
            ("mean height after 2 s", height(119)),
            ("mean height after 3 s", height(179)),
            ("mean height after 10 s", height(STEPS - 1)),
            ("kinetic energy in motion, J a head", mean(MOVING, &kinetic)),
            ("kinetic energy at rest, mJ a head", 1e3 * mean(RESTING, &kinetic)),
            ("energy gained, of that at the start", self.energy_gained(run)),
            ("mean depth of a head after 2 s, mm", 1e3 * after_2.mean),
            ("deepest pair after 2 s, mm", 1e3 * after_2.deepest),
            ("pairs inside each other after 2 s", after_2.inside as f64),
            ("mean depth of a head after 10 s, mm", 1e3 * after_10.mean),
            ("deepest pair after 10 s, mm", 1e3 * after_10.deepest),
            ("pairs inside each other after 10 s", after_10.inside as f64),
            ("peak memory above an empty world, MiB", above),
            ("peak memory of the process, MiB", process),
        ]
    }

    /// Greatest rise of the energy, as a share of that at the start.
    fn energy_gained(&self, run: &Run) -> f64 {
        let weight = f64::from(self.mass) * f64::from(GRAVITY);
        let heights = self.poses.iter().map(|pose| f64::from(pose.translation.y));
        let start = weight * heights.sum::<f64>() / self.poses.len() as f64;
        let energies = (0..STEPS).map(|step| {
            let height = run.mean(step, |head| f64::from(head[1]));
            run.mean(step, |head| self.kinetic(head)) + weight * height
        });
        greatest_rise(std::iter::once(start).chain(energies)) / start
    }

    /// Kinetic energy of a head.
    fn kinetic(&self, head: &[f32]) -> f64 {
        let [_, _, _, i, j, k, w, velocities @ ..] =
            std::array::from_fn::<f64, STATE, _>(|index| f64::from(head[index]));
        let [linear, angular] = [0, 3].map(|index| DVec3::from_slice(&velocities[index..]));
        let angular = DQuat::from_xyzw(i, j, k, w).normalize().inverse() * angular;
        let inertia = self.inertia.as_dvec3();
        0.5 * (f64::from(self.mass) * linear.length_squared() + inertia.dot(angular * angular))
    }

    /// Depths of all pairs of heads.
    fn depths(&self, run: &Run, step: usize, depths: &Depths) -> HeadDepths {
        let pose = |head: &[f32]| {
            let rotation = Quat::from_slice(&head[3..]).normalize();
            Pose3::from_parts(Vec3::from_slice(head), rotation)
        };
        let poses: Vec<Pose3> = run.heads(step).map(pose).collect();
        let lengths = self.mesh.vertices.iter().map(|vertex| vertex.length());
        let reach = 2.0 * lengths.fold(0.0, f32::max);
        let mut of_heads = vec![0.0_f64; poses.len()];
        let mut found = HeadDepths::default();
        for (one, pose) in poses.iter().enumerate() {
            for (other, others) in poses.iter().enumerate().skip(one + 1) {
                // NaN is not far.
                if pose.translation.distance(others.translation) > reach {
                    continue;
                }
                let depth = f64::from(depths.between(pose, depths, others));
                found.inside += usize::from(depth > INSIDE);
                // NaN stays.
                found.deepest = if depth <= found.deepest { found.deepest } else { depth };
                for head in [one, other] {
                    of_heads[head] = of_heads[head].max(depth);
                }
            }
        }
        found.mean = of_heads.iter().sum::<f64>() / poses.len() as f64;
        found
    }
}

/// Depths of heads in each other.
#[derive(Default)]
struct HeadDepths {
    mean: f64,
    deepest: f64,
    inside: usize,
}

/// The file of a run.
struct Run {
    numbers: Vec<f32>,
    step_size: usize,
}

impl Run {
    fn step(&self, step: usize) -> &[f32] {
        &self.numbers[step * self.step_size..][..self.step_size]
    }

    fn header(&self, step: usize) -> [f64; HEADER] {
        std::array::from_fn(|index| f64::from(self.step(step)[index]))
    }

    fn heads(&self, step: usize) -> impl ExactSizeIterator<Item = &[f32]> {
        self.step(step)[HEADER..].chunks_exact(STATE)
    }

    /// Mean of a number over the heads.
    fn mean(&self, step: usize, of: impl Fn(&[f32]) -> f64) -> f64 {
        let heads = self.heads(step);
        let count = heads.len() as f64;
        heads.map(of).sum::<f64>() / count
    }
}

fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn read_numbers(path: &Path) -> io::Result<Vec<f32>> {
    let bytes = fs::read(path)?;
    let (numbers, _) = bytes.as_chunks();
    Ok(numbers.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect())
}

/// Numbers of a scene that are yet to be read.
struct Numbers(std::vec::IntoIter<f32>);

impl Numbers {
    fn take<const N: usize>(&mut self) -> Option<[f32; N]> {
        self.0.by_ref().take(N).collect::<Vec<f32>>().try_into().ok()
    }

    fn list<const N: usize, T>(&mut self, make: impl Fn([f32; N]) -> T) -> Option<Vec<T>> {
        let [count] = self.take()?;
        (0..count as usize).map(|_| self.take().map(&make)).collect()
    }
}

/// Memory of this process in MiB on Linux; else 0.
fn memory(name: &str) -> f32 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with(name));
    let number = line.and_then(|line| line.split_ascii_whitespace().nth(1)?.parse::<f32>().ok());
    number.unwrap_or(0.0) / 1024.0
}
