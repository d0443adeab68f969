//! Parameters of a scene, all drawn from one seed. Lengths are in sizes of the scene.

use rapier3d::parry::mass_properties::MassProperties;

use super::{Family, Options};
use crate::study::hard::heaps::open_box;
use crate::study::hard::kit::*;
use crate::study::hard::resting::ring;

/// Greatest way by which corners of a soup are moved, in sizes: 0.05 mm at a metre. More opens
/// gaps; less is a mesh whose corners are not joined.
const SOUP: f32 = 0.5e-4;

/// Thickness of the walls of trays, and of rooms in the control.
const WALL: f32 = 0.5;

/// Numbers of one scene. Every column draws the same.
pub(super) struct Draw {
    random: Rand32,
    /// Length of a body, in metres.
    pub size: f32,
    pub options: Options,
    /// Gravity, in sizes/s².
    pub gravity: f32,
    /// Time step, in seconds.
    pub dt: f32,
    /// True if the bodies are inserted last to first.
    pub is_reversed: bool,
    /// True if bodies start sunk in each other.
    pub is_sunk: bool,
    /// False if a part has no convex shape for the control.
    pub has_control: bool,
    /// Names of the parts, for the lists.
    pub about: Vec<String>,
}

/// A mesh or a shape of Rapier's, and the convex shape that replaces a mesh in the control.
#[derive(Clone)]
pub(super) struct Part {
    /// The mesh without flaws.
    pub sound: Mesh,
    pub form: Form,
    /// True if all columns have the shape of the control.
    pub is_primitive: bool,
    /// Mass of the part at density 1, in sizes.
    pub mass: MassProperties,
}

impl Part {
    pub fn new(form: Form) -> Self {
        let weighed = form.control.clone().unwrap_or_else(|| form.mesh.shape());
        let mass = weighed.mass_properties(1.0);
        Self { sound: form.mesh.clone(), form, is_primitive: false, mass }
    }

    /// A mesh without flaws.
    pub fn clean(mesh: Mesh, control: Option<SharedShape>) -> Self {
        Self::new(Form { mesh, control })
    }
}

impl Draw {
    pub fn new(family: Family, options: Options, number: u32) -> Self {
        let mixed = options.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = mixed ^ u64::from(number).rotate_left(32);
        let mut random = Rand32::new(mixed ^ ((family as u64) << 56));
        let mut log = |low: f32, high: f32| low * (high / low).powf(random.rand_float());
        let (size, gravity) = (log(0.01, 100.0), log(2.0, 30.0));
        // Coarser steps resolve no fall from a size high; finer ones only take time.
        let [fine, coarse] = [0.015, 0.07].map(|share| share / gravity.sqrt());
        let dt = log(fine.max(1.0 / 240.0), coarse.min(1.0 / 30.0));
        let is_reversed = random.rand_range(0..2) == 1;
        let about = vec![format!("size {size:.2}, {gravity:.1}/s², {:.0} Hz", 1.0 / dt)];
        let (is_sunk, has_control) = (false, true);
        Self { random, size, options, gravity, dt, is_reversed, is_sunk, has_control, about }
    }

    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.random.rand_float()
    }

    /// A number whose logarithm is distributed evenly.
    pub fn log(&mut self, low: f32, high: f32) -> f32 {
        low * (high / low).powf(self.random.rand_float())
    }

    /// A number of things, small ones as often as large ones.
    pub fn count(&mut self, low: u32, high: u32) -> u32 {
        (self.log(low as f32, high as f32 + 0.99) as u32).clamp(low, high)
    }

    pub fn chance(&mut self, share: f32) -> bool {
        self.random.rand_float() < share
    }

    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.random.rand_range(0..of.len() as u32) as usize]
    }

    pub fn turn(&mut self) -> Quat {
        random::rotation(&mut self.random)
    }

    /// A turn about the `y` axis.
    pub fn yaw(&mut self) -> Quat {
        Quat::from_rotation_y(self.within(0.0, TAU))
    }

    fn seed(&mut self) -> u64 {
        u64::from(self.random.rand_u32())
    }

    /// Number of steps of so many seconds.
    pub fn steps(&self, seconds: f32) -> usize {
        (seconds / self.dt) as usize
    }

    fn tell(&mut self, name: &str, triangles: usize) {
        self.about.push(format!("{name} {triangles}"));
    }

    /// A flat ground, its top at height 0 and at most 4000 triangles.
    pub fn ground(&mut self, half: f32) -> Part {
        const DEEP: f32 = 1.0;
        let (cells, seed) = (self.count(1, 36), self.seed());
        let sheet = mesh::floor(2.0 * half, cells);
        let down = |mesh: Mesh| mesh.mapped(|v| v - 0.5 * DEEP * Vec3::Y);
        let halves = Vec3::new(half, 0.5 * DEEP, half);
        let names = ["sheet", "slab", "strips", "soup", "doubles", "two sides", "any winding"];
        let name = self.pick(&[&names[..], &["tiles", "uneven slab", "uneven sheet"]].concat());
        let mesh = match name {
            "slab" => down(mesh::slab(halves, [cells, 1, cells])),
            "strips" => mesh::strips(2.0 * half, self.count(2, 16), seed),
            "soup" => mesh::unwelded(&sheet, SOUP, seed),
            "doubles" => mesh::doubled(&sheet, self.count(1, 5) as usize),
            "two sides" => mesh::two_sided(&sheet),
            "any winding" => mesh::random_winding(&sheet, seed),
            "tiles" => mesh::tiles(2.0 * half, cells.min(16), DEEP),
            "uneven slab" => down(self.uneven_box(halves, 24)),
            "uneven sheet" => self.warped(sheet, half),
            _ => sheet,
        };
        self.tell(name, mesh.triangle_count());
        let cuboid = SharedShape::cuboid(half, DEEP, half);
        let control = SharedShape::compound(vec![(Pose3::translation(0.0, -DEEP, 0.0), cuboid)]);
        Part::clean(mesh, Some(control))
    }

    /// The sheet with narrow triangles on one side and wide ones on the other.
    fn warped(&mut self, sheet: Mesh, half: f32) -> Mesh {
        let [along, across] = [(); 2].map(|()| self.within(0.3, 3.0));
        let warp = |x: f32, power: f32| half * (2.0 * (0.5 + 0.5 * x / half).powf(power) - 1.0);
        sheet.mapped(|v| Vec3::new(warp(v.x, along), v.y, warp(v.z, across)))
    }

    fn uneven_box(&mut self, halves: Vec3, most: u32) -> Mesh {
        mesh::uneven_box(halves, [(); 6].map(|()| self.count(1, most)))
    }

    /// A box, mostly a mesh, with flaws or without.
    pub fn brick(&mut self, halves: Vec3) -> Part {
        let cells = self.count(1, 8);
        let even = mesh::cuboid(halves, cells);
        let part = Part::new(Form::cuboid(halves, cells));
        let names = ["cuboid", "brick", "uneven brick", "flawed brick", "two-sided brick", "hole"];
        // An open surface has no inside to be pushed out of.
        let name = self.pick(&names[..if self.is_sunk { 4 } else { 6 }]);
        let mesh = match name {
            "uneven brick" => self.uneven_box(halves, 8),
            "flawed brick" => self.flawed(&even),
            "two-sided brick" => mesh::two_sided(&even),
            "hole" => {
                let mut brick = mesh::cuboid(halves, cells.max(3));
                // The first triangle that touches no edge of the box.
                brick.triangles.remove(2 * (cells.max(3) as usize + 1));
                brick
            }
            _ => even,
        };
        self.part(name, mesh, part)
    }

    /// A ball of radius 0.5, mostly a mesh, with flaws or without. In the control it is the hull.
    pub fn ball(&mut self) -> Part {
        let even = mesh::ball(0.5, self.count(5, 14));
        let name = self.pick(&["ball", "mesh ball", "uneven ball", "flawed ball"]);
        let mesh = match name {
            "uneven ball" => mesh::cube_ball(0.5, [(); 6].map(|()| self.count(5, 12))),
            "flawed ball" => self.flawed(&even),
            _ => even.clone(),
        };
        let hull = SharedShape::convex_hull(&mesh.vertices);
        let control = if name == "ball" { Some(SharedShape::ball(0.5)) } else { hull };
        self.part(name, mesh, Part::clean(even, control))
    }

    /// A shape of Rapier's, in all columns.
    pub fn primitive(&mut self, name: &str, shape: SharedShape) -> Part {
        self.tell(name, 0);
        let mesh = mesh::cuboid(Vec3::ONE, 1);
        Part { is_primitive: true, ..Part::clean(mesh, Some(shape)) }
    }

    /// A closed body about a size long: a brick, a ball, a ring or a head.
    pub fn solid(&mut self) -> Part {
        let halves = Vec3::from_array([(); 3].map(|()| self.within(0.25, 0.6)));
        match self.pick(&["brick", "ball", "ring", "head"]) {
            "brick" => self.brick(halves),
            "ball" => self.ball(),
            "ring" => {
                let segments = [self.count(12, 24), self.count(6, 12)];
                let tube = self.within(0.12, 0.2);
                let ring = Part::new(ring(0.55 - tube, tube, segments));
                self.sometimes_flawed("ring", ring)
            }
            _ => {
                let head = mesh::monkey_head_with(self.count(5, 10)).centred().scaled_to(1.1);
                self.sometimes_flawed("head", Part::clean(head, None))
            }
        }
    }

    /// The part, or the same with a flawed mesh.
    pub fn sometimes_flawed(&mut self, name: &str, part: Part) -> Part {
        let mesh = part.sound.clone();
        let mesh = if self.chance(0.3) { self.flawed(&mesh) } else { mesh };
        self.part(name, mesh, part)
    }

    pub fn part(&mut self, name: &str, mesh: Mesh, part: Part) -> Part {
        let is_primitive = matches!(name, "cuboid" | "ball");
        self.has_control &= part.form.control.is_some();
        self.tell(name, if is_primitive { 0 } else { mesh.triangle_count() });
        Part { form: Form { mesh, ..part.form }, is_primitive, ..part }
    }

    /// The closed mesh as a soup, or with triangles twice. Both leave inside and outside as they
    /// are.
    pub fn flawed(&mut self, mesh: &Mesh) -> Mesh {
        let (seed, nth) = (self.seed(), self.count(1, 5) as usize);
        if self.chance(0.5) { mesh::unwelded(mesh, SOUP, seed) } else { mesh::doubled(mesh, nth) }
    }
    /// A square tray, its bottom at height 0.
    pub fn tray(&mut self) -> Part {
        let [half, rim] = [(2.2, 3.0), (1.5, 4.0)].map(|(low, high)| self.within(low, high));
        let diagonals = [half, half + WALL].map(|half| half * 2.0_f32.sqrt());
        let turn = Pose3::from_rotation(Quat::from_rotation_y(FRAC_PI_4));
        let tray = open_box(diagonals, rim, WALL).posed(&turn);
        let up = 0.5 * rim * Vec3::Y;
        let boxes = walls(Vec3::new(half, 0.5 * rim, half), false);
        let boxes = boxes.into_iter().map(|[at, sides]| [at + up, sides]).collect();
        self.sometimes_flawed("tray", Part::clean(tray, Some(compound(&boxes))))
    }

    /// A closed box about the origin, its faces outward.
    pub fn room(&mut self, halves: Vec3) -> Part {
        let cells = [(); 6].map(|()| self.count(1, 12));
        let room = if self.chance(0.5) {
            mesh::uneven_box(halves, cells)
        } else {
            mesh::cuboid(halves, cells[0])
        };
        self.sometimes_flawed("room", Part::clean(room, Some(compound(&walls(halves, true)))))
    }

    /// A table of a top and four legs, with half their sides, its feet at height 0.
    pub fn table(&mut self, top: Vec3, leg: Vec3) -> Part {
        let at = (top - leg) * 0.95;
        let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]];
        let legs = corners.map(|[x, z]| [Vec3::new(x * at.x, leg.y, z * at.z), leg]);
        let boxes = [&legs[..], &[[(2.0 * leg.y + top.y) * Vec3::Y, top]]].concat();
        // Faces of legs and top lie within the table.
        let meshes = boxes
            .iter()
            .map(|&[at, half]| mesh::cuboid(half, self.count(1, 4)).mapped(|vertex| vertex + at));
        let table = Mesh::merged("table", &meshes.collect::<Vec<Mesh>>());
        self.sometimes_flawed("table", Part::clean(table, Some(compound(&boxes))))
    }
}

/// Boxes, each with its middle and half its sides.
type Boxes = Vec<[Vec3; 2]>;

fn compound(boxes: &Boxes) -> SharedShape {
    let cuboid = |&[at, half]: &[Vec3; 2]| {
        (Pose3::from_translation(at), SharedShape::cuboid(half.x, half.y, half.z))
    };
    SharedShape::compound(boxes.iter().map(cuboid).collect())
}

/// The six walls around a room, or without the one above.
fn walls(halves: Vec3, has_roof: bool) -> Boxes {
    let sides = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let sides = sides.filter(|side| has_roof || side.y <= 0.0);
    let wall = |side: Vec3| {
        let half = (halves + Vec3::splat(2.0 * WALL)) * (Vec3::ONE - side.abs());
        [side * (halves + Vec3::splat(WALL)), half + WALL * side.abs()]
    };
    sides.map(wall).collect()
}
