//! Parts of machines: solids that are pulled out of an outline or turned about an axis.

use std::f32::consts::{PI, TAU};

use glamx::{Vec2, Vec3};

use super::Mesh;
use super::shapes::{quad_grid, without_needles};

/// A solid between `-half_width` and `half_width` along `z`. Its outline runs counter-clockwise
/// seen from `+z`, and all of it must be seen from the origin.
pub fn prism(outline: &[Vec2], half_width: f32) -> Mesh {
    let count = outline.len() as u32;
    let solid = quad_grid([count, 3], |i, j| {
        let point = outline[(i % count) as usize];
        match j {
            0 => Vec3::Z * -half_width,
            1 => point.extend(-half_width),
            2 => point.extend(half_width),
            _ => Vec3::Z * half_width,
        }
    });
    without_needles(&solid).named("prism")
}

/// A profile of `(distance from the axis, height)`, turned once about the `y` axis in `segments`
/// parts. The solid is to the left of the profile. A closed profile, whose last point is the
/// first, makes a ring; one that starts and ends on the axis, a solid without a hole.
pub fn revolved(profile: &[Vec2], segments: u32) -> Mesh {
    let count = profile.len() as u32 - 1;
    let solid = quad_grid([count, segments], |i, j| {
        let (sin, cos) = (TAU * (j % segments) as f32 / segments as f32).sin_cos();
        // The last point is the first, if they are the same.
        let Vec2 { x, y } = profile[i as usize];
        Vec3::new(x * cos, y, x * sin)
    });
    without_needles(&solid).named("revolved")
}

/// A spur gear about the `z` axis.
#[derive(Clone, Copy, Debug)]
pub struct Gear {
    /// Teeth; from 18 on none is undercut.
    pub teeth: u32,
    /// Pitch diameter over teeth, in units.
    pub module: f32,
    /// Difference of a gap of the mate and a tooth, on the pitch circle.
    pub thinned: f32,
    /// Half the length of a tooth along the axis.
    pub half_width: f32,
}

impl Gear {
    /// Angle between tooth flank and radius on the pitch circle: the usual one.
    const PRESSURE_ANGLE: f32 = PI / 9.0;
    /// Points of a flank.
    const FLANK_POINTS: u32 = 7;

    /// Radius on which two gears roll on each other.
    pub fn pitch_radius(&self) -> f32 {
        0.5 * self.module * self.teeth as f32
    }

    /// Outline of the tooth at the `x` axis, counter-clockwise, with involute flanks.
    fn tooth(&self) -> Vec<Vec2> {
        let involute = |angle: f32| angle.tan() - angle;
        let pitch = self.pitch_radius();
        let base = pitch * Self::PRESSURE_ANGLE.cos();
        let half_angle = |radius: f32| {
            let thickness = 0.5 * PI * self.module - self.thinned;
            let angle = (base / radius).min(1.0).acos();
            0.5 * thickness / pitch + involute(Self::PRESSURE_ANGLE) - involute(angle)
        };
        let foot = pitch - 1.25 * self.module;
        let steps = (0..Self::FLANK_POINTS).map(|k| k as f32 / (Self::FLANK_POINTS - 1) as f32);
        let rising = steps.map(|share| base + share * (pitch + self.module - base));
        let flank: Vec<Vec2> = [foot]
            .into_iter()
            .chain(rising)
            .map(|radius| radius * Vec2::from_angle(half_angle(radius)))
            .collect();
        let lower = flank.iter().map(|point| Vec2::new(point.x, -point.y));
        lower.chain(flank.iter().rev().copied()).collect()
    }

    /// Outlines of all teeth, counter-clockwise. The first is at the `x` axis.
    pub fn outlines(&self) -> Vec<Vec<Vec2>> {
        let tooth = self.tooth();
        let turned = |index: u32| {
            let turn = Vec2::from_angle(TAU * index as f32 / self.teeth as f32);
            tooth.iter().map(|&point| turn.rotate(point)).collect()
        };
        (0..self.teeth).map(turned).collect()
    }

    pub fn mesh(&self) -> Mesh {
        prism(&self.outlines().concat(), self.half_width).named("gear")
    }
}

/// A rack along the `y` axis that a [`Gear`] runs on.
#[derive(Clone, Copy, Debug)]
pub struct Rack {
    /// The gear on the rack, with its axis at the origin.
    pub gear: Gear,
    /// Teeth, half of them to either side of the gap that the first tooth of the gear is in.
    pub teeth: u32,
    /// From the line on which the gear rolls to its back, in units.
    pub depth: f32,
}

impl Rack {
    /// The corners of a tooth along `y`, from foot to foot.
    pub fn tooth(&self, tooth: u32) -> [Vec2; 4] {
        let Gear { module, thinned, .. } = self.gear;
        let pitch = PI * module;
        let middle = pitch * (tooth as f32 + 0.5 - 0.5 * self.teeth as f32);
        let line = self.gear.pitch_radius();
        // Half as thick as the pitch where the gear rolls.
        let half = 0.25 * pitch - 0.5 * thinned;
        let at = |side: f32, beyond: f32| {
            let half = half - beyond * Gear::PRESSURE_ANGLE.tan();
            Vec2::new(line - beyond, middle + side * half)
        };
        let [foot, head] = [-1.25 * module, module];
        [at(-1.0, foot), at(-1.0, head), at(1.0, head), at(1.0, foot)]
    }

    pub fn mesh(&self) -> Mesh {
        let line: Vec<Vec2> = (0..self.teeth).flat_map(|tooth| self.tooth(tooth)).collect();
        let back = self.gear.pitch_radius() + self.depth;
        let rows = line.len() as u32;
        let half_width = self.gear.half_width;
        let solid = quad_grid([4, rows + 1], |i, j| {
            let point = line[(j.max(1) - 1).min(rows - 1) as usize];
            match i % 4 {
                _ if j == 0 || j > rows => Vec3::new(back, point.y, 0.0),
                0 => Vec3::new(back, point.y, -half_width),
                1 => point.extend(-half_width),
                2 => point.extend(half_width),
                _ => Vec3::new(back, point.y, half_width),
            }
        });
        without_needles(&solid).named("rack")
    }
}

/// A screw thread about the `y` axis, from height 0 upwards.
#[derive(Clone, Copy, Debug)]
pub struct Thread {
    /// Least radius of the bolt, in units.
    pub root: f32,
    /// Height of the thread, in units.
    pub height: f32,
    /// Rise of one turn, in units.
    pub pitch: f32,
    /// Lean of the flanks at each side, as a share of the pitch.
    pub flank: f32,
    /// Added thickness of the thread at each side, as a share of the pitch; with the flank, less
    /// than 0.4.
    pub thicker: f32,
    pub turns: u32,
    /// Vertices of a turn.
    pub segments: u32,
}

impl Thread {
    /// A bolt with a lead angle of 1.9 degrees.
    pub const BOLT: Self = Self {
        root: 0.9,
        height: 0.1,
        pitch: 0.2,
        flank: 0.1,
        thicker: 0.0,
        turns: 6,
        segments: 48,
    };

    /// For a nut on [`Self::BOLT`], with a tenth of a pitch of play, and so much less deep.
    pub const NUT: Self = Self { root: 0.92, thicker: 0.05, turns: 2, ..Self::BOLT };

    /// Where the corners of the profile are in each turn, as a share of the pitch, and how much of
    /// the height they stand out. Slopes are steep, so that facets of bolt and nut hardly make the
    /// nut go up and down.
    fn profile(&self) -> [[f32; 2]; 5] {
        let [low, high] = [-self.thicker, self.thicker];
        let [foot, end] = [0.4 - self.flank, 0.6 + self.flank];
        [[0.0, 0.0], [foot + low, 0.0], [0.4 + low, 1.0], [0.6 + high, 1.0], [end + high, 0.0]]
    }

    /// Corners of the profile over all turns, those of one more, as the thread winds, and the end.
    fn row_count(&self) -> u32 {
        self.profile().len() as u32 * (self.turns + 1) + 1
    }

    /// The corner of a row at an angle. What would be below or above the part is at its end.
    fn point(&self, angle: u32, row: u32) -> Vec3 {
        let segments = self.segments;
        let profile = self.profile();
        let [turn, corner] = [row / profile.len() as u32, row % profile.len() as u32];
        // The last angle is the first, and its rows are a turn higher.
        let share = (angle % segments) as f32 / segments as f32;
        let [place, stands_out] = profile[corner as usize];
        let height = (turn + angle / segments) as f32 - 1.0 + place + share;
        let ended = height.clamp(0.0, self.turns as f32);
        let stands_out = if height == ended {
            stands_out
        } else {
            self.stands_out((ended - share).rem_euclid(1.0))
        };
        self.around(angle, self.root + self.height * stands_out, self.pitch * ended)
    }

    /// Share of the height by which the thread stands out at a share of the pitch.
    fn stands_out(&self, place: f32) -> f32 {
        let corners = self.profile().into_iter().chain([[1.0, 0.0]]);
        let ends = self.profile().into_iter().zip(corners.skip(1));
        let side = ends.into_iter().find(|(_, end)| place <= end[0]);
        side.map_or(0.0, |([from, low], [to, high])| {
            low + (high - low) * (place - from) / (to - from)
        })
    }

    fn around(&self, angle: u32, radius: f32, height: f32) -> Vec3 {
        let angle = TAU * (angle % self.segments) as f32 / self.segments as f32;
        Vec3::new(radius * angle.sin(), height, radius * angle.cos())
    }

    /// A bolt without a head.
    pub fn bolt(&self) -> Mesh {
        let rows = self.row_count();
        self.solid("bolt", rows + 1, |i, j| match j {
            0 => Vec3::ZERO,
            j if j > rows => Vec3::Y * self.pitch * self.turns as f32,
            j => self.point(i, j - 1),
        })
    }

    /// A round nut of this radius that this thread is cut into.
    pub fn nut(&self, radius: f32) -> Mesh {
        let rows = self.row_count();
        self.solid("nut", rows + 2, |i, j| match j {
            j if j == 0 || j == rows + 2 => self.around(i, radius, 0.0),
            1 => self.around(i, radius, self.pitch * self.turns as f32),
            j => self.point(i, rows + 1 - j),
        })
    }

    fn solid(&self, name: &str, rows: u32, point: impl Fn(u32, u32) -> Vec3) -> Mesh {
        without_needles(&quad_grid([self.segments, rows], point)).named(name)
    }
}
