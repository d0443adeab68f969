//! The study of queries as files and as a picture.

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use super::{Grid, ResultRow, Results, tables};
use crate::metrics::Environment;
use crate::study::contacts::CONTESTANTS;
use crate::study::queries::{Place, Queries, Query};

fn panel(queries: &Queries, query: Query, place: Place) -> Panel {
    let rows = || queries.rows.iter().filter(move |row| (row.query, row.place) == (query, place));
    let series = [0, 1].map(|side| Series {
        label: CONTESTANTS[side].to_string(),
        look: Look::Backend(CONTESTANTS[side]),
        is_connected: true,
        points: rows()
            .map(|row| (row.triangle_count as f64, row.sides[side].time.median))
            .collect(),
    });
    Panel {
        title: format!("{query}, {place}"),
        x_label: "triangles of each mesh".to_owned(),
        y_label: "µs a query".to_owned(),
        scale: Scale::Logarithmic { zero: None },
        series: series.into(),
    }
}

impl Results for Queries {
    fn environment(&self) -> &Environment {
        &self.environment
    }

    fn tables(&self) -> Vec<Grid> {
        tables::one_answer(self).into()
    }

    fn rows(&self) -> Vec<ResultRow> {
        let rows = self.rows.iter().flat_map(|row| {
            let scene = format!(
                "{}, {}, {} of {} triangles",
                row.query, row.place, row.mesh, row.triangle_count
            );
            row.sides.iter().map(move |side| ResultRow::new("queries, µs", scene.clone(), side))
        });
        rows.collect()
    }

    /// Time by number of triangles, for the distance of meshes that are near, for the intersection test of meshes that
    /// hardly miss each other, and for casts.
    fn panels(&self) -> Vec<Panel> {
        vec![
            panel(self, Query::Distance, Place::Near),
            panel(self, Query::Intersection, Place::HardlyApart),
            panel(self, Query::Cast, Place::Far),
        ]
    }
}
