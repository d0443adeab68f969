//! Names for the parts of two triangles that make a contact.

/// A part of a triangle. Edge `i` runs from vertex `i` to vertex `(i + 1) % 3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Feature {
    /// Vertex 0, 1 or 2.
    Vertex(u8),
    /// Edge 0, 1 or 2.
    Edge(u8),
    /// The triangle itself.
    Face,
}

impl Feature {
    /// Width of [`to_bits`](Self::to_bits).
    const BITS: u32 = 3;
    const MASK: u8 = (1 << Self::BITS) - 1;
    const EDGE: u8 = 0b100;
    const INDEX: u8 = 0b011;

    /// `0ii` for vertex i, `1ii` for edge i, `011` for the face.
    const fn to_bits(self) -> u8 {
        match self {
            Self::Vertex(i) => i,
            Self::Edge(i) => Self::EDGE | i,
            Self::Face => Self::INDEX,
        }
    }

    /// The reverse of [`to_bits`](Self::to_bits); higher bits do not count. `111`, which is no
    /// feature, reads as the face.
    #[inline(always)]
    const fn from_bits(bits: u8) -> Self {
        const FEATURES: [Feature; 8] = [
            Feature::Vertex(0),
            Feature::Vertex(1),
            Feature::Vertex(2),
            Feature::Face,
            Feature::Edge(0),
            Feature::Edge(1),
            Feature::Edge(2),
            Feature::Face,
        ];
        FEATURES[(bits & Self::MASK) as usize]
    }

    /// Index of a vertex of the feature.
    pub(super) const fn vertex(self) -> usize {
        match self {
            Self::Vertex(i) | Self::Edge(i) => i as usize,
            Self::Face => 0,
        }
    }
}

/// The features of triangles 1 and 2 that realise a contact, in seven bits.
///
/// Apart: the closest features. Crossing: the axis of least translation, where a face stands for
/// its normal and two edges for their cross product.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FeaturePair(u8);

impl FeaturePair {
    /// The bits of [`to_bits`](Self::to_bits).
    pub const MASK: u8 = (1 << (2 * Feature::BITS + 1)) - 1;
    const CROSSING: u8 = 1 << (2 * Feature::BITS);

    /// `feature1` belongs to triangle 1.
    pub const fn new(feature1: Feature, feature2: Feature) -> Self {
        Self(feature1.to_bits() | feature2.to_bits() << Feature::BITS)
    }

    /// Marks the features as the axis of a crossing contact.
    pub(super) const fn crossing(self) -> Self {
        Self(self.0 | Self::CROSSING)
    }

    /// The feature of triangle 1.
    pub const fn feature1(self) -> Feature {
        Feature::from_bits(self.0)
    }

    /// The feature of triangle 2.
    pub const fn feature2(self) -> Feature {
        Feature::from_bits(self.0 >> Feature::BITS)
    }

    /// True if the features stand for the axis of a crossing contact.
    pub const fn is_crossing(self) -> bool {
        self.0 & Self::CROSSING != 0
    }

    /// Feature 1 in the low three bits, feature 2 in the next three, then whether they cross.
    pub const fn to_bits(self) -> u8 {
        self.0
    }

    /// The reverse of [`to_bits`](Self::to_bits); any value is allowed, higher bits do not count.
    pub const fn from_bits(bits: u8) -> Self {
        // `111` in one of both places, which is no feature, becomes the face.
        let none = bits & bits >> 1 & bits >> 2 & 0b001001;
        Self(bits & Self::MASK & !(none << 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn features() -> impl Iterator<Item = Feature> {
        let vertices = (0..3).map(Feature::Vertex);
        vertices.chain((0..3).map(Feature::Edge)).chain([Feature::Face])
    }

    #[test]
    fn feature_pairs_survive_packing() {
        let mut seen = std::collections::HashSet::new();
        for (f1, f2) in features().flat_map(|f1| features().map(move |f2| (f1, f2))) {
            let pair = FeaturePair::new(f1, f2);
            assert_eq!((pair.feature1(), pair.feature2()), (f1, f2));
            assert_eq!(FeaturePair::from_bits(pair.to_bits()), pair);
            assert_eq!(pair.to_bits() & !FeaturePair::MASK, 0);
            let crossing = pair.crossing();
            assert_eq!((crossing.feature1(), crossing.feature2()), (f1, f2));
            assert!(crossing.is_crossing() && !pair.is_crossing());
            assert!(seen.insert(pair) && seen.insert(crossing));
        }
        assert_eq!(seen.len(), 98);
    }

    #[test]
    fn any_byte_reads_as_features() {
        for bits in 0..=u8::MAX {
            let pair = FeaturePair::from_bits(bits);
            assert!(pair.feature1().vertex() < 3 && pair.feature2().vertex() < 3);
        }
    }
}
