use std::cell::Cell;

use super::super::contact::NormalSource;
use super::*;

fn contact(distance: f64, feature: Feature) -> PartContact {
    let point = DVec3::new(0.5, 0.0, 0.0);
    let contact = ConvexContact { distance, normal: DVec3::Y, on_triangle: point, on_shape: point };
    PartContact { contact, feature, source: NormalSource::Own }
}

/// Returns the corners of triangle `i` of a strip: triangles share edges with the next ones.
fn strip(i: u32) -> [u64; 3] {
    [i, i + 1, i + 2].map(|i| corner_key(0, Vec3::new(i as f32, (i % 2) as f32, 0.0)))
}

/// Catches a search for neighbours that visits all contacts for each contact.
#[test]
fn contacts_visited_grow_with_the_number_of_contacts() {
    const COUNT: u32 = 32_768;
    let contacts: Vec<_> = (0..COUNT).map(|i| ([i, 0], contact(-0.1, Feature::Edge(1)))).collect();
    let (mut ghosts, calls) = (GhostContacts::default(), Cell::new(0));
    let extends_beyond = |_: [u32; 2], _: &ConvexContact| {
        calls.set(calls.get() + 1);
        false
    };
    ghosts.find(&contacts, |[i, _]| strip(i), extends_beyond, |_, _| {}, |_, _| None);
    assert!(calls.get() <= 6 * COUNT, "{} calls", calls.get());
    for i in 0..COUNT {
        ghosts.list_nearby(i);
        assert!(ghosts.nearby.len() <= 5, "{} neighbours of {i}", ghosts.nearby.len());
    }
}

/// Catches ghosts that take the normal of a ghost, and contacts at faces that count as ghosts.
#[test]
fn chains_of_ghosts_end_at_the_nearest_contact() {
    for count in [4, 40] {
        let of = |i: u32| ([i, 0], contact(0.01 * f64::from(i), Feature::Edge(0)));
        let mut contacts: Vec<_> = (0..count).map(of).collect();
        let mut ghosts = GhostContacts::default();
        ghosts.find(&contacts, |[i, _]| strip(i), |_, _| true, |_, _| {}, |_, _| None);
        assert_eq!(ghosts.sources, vec![0; count as usize]);
        assert!(ghosts.exceeded.is_empty(), "nothing crosses");
        contacts[2].1.feature = Feature::Face;
        contacts[1].1.contact.distance = -0.3;
        contacts[2].1.contact.distance = -0.2;
        ghosts.find(&contacts, |[i, _]| strip(i), |_, _| true, |_, _| {}, |_, _| None);
        assert_eq!(ghosts.sources[..4], [0, 1, 2, 2]);
        assert_eq!(ghosts.exceeded, [1]);
        ghosts.list_nearby(1);
        assert_eq!(ghosts.nearby, [1, 0, 2, 3]);
    }
}
/// Two contacts at one vertex, and one at an edge between them in the list. Catches strays of
/// the edge that count for the vertex.
#[test]
fn strays_belong_to_their_contact() {
    let at = |feature| contact(-0.1, feature);
    let mut contacts: Vec<_> =
        [Feature::Vertex(0), Feature::Edge(0), Feature::Vertex(0), Feature::Face]
            .into_iter()
            .zip(0..)
            .map(|(feature, i)| ([i, 0], at(feature)))
            .collect();
    contacts[2].1.contact.normal = DVec3::X;
    let mut ghosts = GhostContacts::default();
    let keys = |[i, _]: [u32; 2]| strip([0, 10, 0, 20][i as usize]);
    let extends_beyond = |[i, _]: [u32; 2], _: &ConvexContact| i == 3;
    let strays = |([i, _], _): &Hit, strays: &mut Vec<u32>| {
        strays.extend((*i == 1).then_some(3));
    };
    ghosts.find(&contacts, keys, extends_beyond, strays, |_, _| None);
    assert_eq!(ghosts.exceeded, [1]);
}
