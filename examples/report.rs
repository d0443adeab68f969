//! All studies on one page: time against error, the paper's experiments, cost, everyday and hard
//! scenes.
//!
//! ```text
//! cargo run --release --example report
//! cargo run --release --example report -- --quick --only one-step,cost --html report.html
//! ```

use std::env;
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::report::{Results, Section, check_files, write_html};
use sbbk_lab::study::compare::{ComparePlan, compare};
use sbbk_lab::study::contacts::{ContactsPlan, contacts};
use sbbk_lab::study::cost::{CostPlan, cost};
use sbbk_lab::study::everyday::{EverydayPlan, everyday};
use sbbk_lab::study::floor::{FloorPlan, floor};
use sbbk_lab::study::hard::{HardPlan, hard};
use sbbk_lab::study::one_step::{OneStepPlan, one_step};
use sbbk_lab::study::{Progress, StudyError};

/// A part of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Part {
    OneStep,
    Contacts,
    Paper,
    Cost,
    Floor,
    Everyday,
    Hard,
}

/// Runs the studies, and writes one page and the numbers behind it.
#[derive(Parser)]
struct Arguments {
    /// The page
    #[arg(long, value_name = "FILE", default_value = "report.html")]
    html: PathBuf,
    /// All numbers, one a line
    #[arg(long, value_name = "FILE", default_value = "report.csv")]
    csv: PathBuf,
    /// Runs only these parts
    #[arg(long, value_name = "PARTS", value_delimiter = ',')]
    only: Vec<Part>,
    /// Who is compared in single steps and in cost
    #[arg(long, value_name = "BACKENDS", value_delimiter = ',', default_value = "stock,sbbk")]
    backends: Vec<Backend>,
    /// Measures less: for trying, not for quoting
    #[arg(long)]
    quick: bool,
}

impl Arguments {
    fn plan<P>(&self, standard: fn() -> P, quick: fn() -> P) -> P {
        if self.quick { quick() } else { standard() }
    }

    fn section(&self, part: Part, progress: &Progress) -> Result<Section, StudyError> {
        let backends = self.backends.clone();
        let (title, text, results) = match part {
            Part::OneStep => {
                let plan = self.plan(OneStepPlan::standard, OneStepPlan::quick);
                let text = "How far the velocities after one step are from those of a converged \
                            solver with every contact, for several numbers of substeps.";
                ("Time against error", text, one_step(&OneStepPlan { backends, ..plan }, progress))
            }
            Part::Contacts => {
                let plan = self.plan(ContactsPlan::standard, ContactsPlan::quick);
                let text = "Contacts of two meshes, each pair of triangles judged by brute force.";
                ("Contacts", text, contacts(&plan, progress))
            }
            Part::Paper => {
                let plan = self.plan(ComparePlan::standard, ComparePlan::quick);
                let text = "The experiments of the SBBK paper, its own numbers among ours; what \
                            trees cost in memory and to build.";
                ("The paper's experiments, memory and builds", text, compare(&plan, progress))
            }
            Part::Cost => {
                let plan = self.plan(CostPlan::standard, CostPlan::quick);
                let text = "Piles of more and more heads, and of heads of more and more triangles.";
                ("Cost", text, cost(&CostPlan { backends, ..plan }, progress))
            }
            Part::Floor => {
                let plan = self.plan(FloorPlan::standard, FloorPlan::quick);
                let text = "What the search for contacts takes above the writing of them.";
                ("The floor", text, floor(&plan, progress))
            }
            Part::Everyday => {
                let plan = self.plan(EverydayPlan::standard, EverydayPlan::quick);
                let text = "What meshes are mostly used for.";
                ("Everyday scenes", text, everyday(&plan, progress)?)
            }
            Part::Hard => {
                let plan = self.plan(HardPlan::standard, HardPlan::quick);
                ("Hard scenes", "Scenes that are difficult for meshes.", hard(&plan, progress)?)
            }
        };
        Ok(Section { title, text, results })
    }
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    check_files(&[], &[&arguments.html, &arguments.csv])?;
    let progress = Progress::visible();
    let parts = Part::value_variants().iter().copied();
    let wanted = parts.filter(|part| arguments.only.is_empty() || arguments.only.contains(part));
    let sections = wanted.map(|part| arguments.section(part, &progress));
    let sections = sections.collect::<Result<Vec<Section>, _>>()?;
    let given: Vec<String> = env::args().skip(1).collect();
    let command = format!("cargo run --release --example report -- {}", given.join(" "));
    let command = command.trim_end_matches([' ', '-']);
    write_html(&arguments.html, "Stock Rapier beside SBBK", command, &sections)?;
    if let Some(all) = Results::joined(sections.into_iter().map(|section| section.results)) {
        all.write_csv(&arguments.csv)?;
    }
    print(format_args!("{}\n{}", arguments.html.display(), arguments.csv.display()))?;
    Ok(())
}
