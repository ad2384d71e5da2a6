//! `cargo xtask interop`: checks of the files that Sabi writes, by libraries and programs of others.
//!
//! The tools come from the ordinary registries of Python and Node.js, into a folder of their own below the target
//! folder.

use std::path::{Path, PathBuf};
use std::process::Stdio;

use xtask::packages::program;
use xtask::project::{Project, TaskError, create_folder, finish};
use xtask::vulkan::{self, Driver};

/// Python packages of the checks, with the versions that they were written for.
const PYTHON_PACKAGES: [&str; 5] = [
    "numpy",
    "MaterialX==1.39.5",
    "usd-core==26.11",
    "openjd-cli==0.8.0",
    "OpenImageIO==3.2.2.0",
];
/// Renderers, which exist for few versions of Python and ask for a version of NumPy.
const RENDERERS: [&str; 2] = ["bpy", "f3d==4.0.0"];
/// Node.js packages of the checks.
const NODE_PACKAGES: [&str; 1] = ["gltf-validator@2.0.0-dev.3.10"];
/// Models whose copies are validated, and the graphs on them.
const COPIES: [(&str, &str); 4] = [
    ("crate.glb", "army-paint.sabi"),
    ("table.glb", "worn-oak.sabi"),
    ("figure.glb", "bronze-statue.sabi"),
    ("chair.glb", "leather.sabi"),
];

/// Installs the tools, builds, bakes and runs every check.
pub(crate) fn run(project: &Project) -> Result<(), TaskError> {
    vulkan::ensure(project, Driver::Any)?;
    let tools = Tools::install(project)?;
    let build = [
        "build",
        "--release",
        "--locked",
        "--package",
        "sabi",
        "--no-default-features",
    ];
    finish(project.cargo(&build)?, "Building sabi")?;
    let checks: [(&str, Check); 8] = [
        ("presets", presets),
        ("pictures", pictures),
        ("reports", reports),
        ("documents", documents),
        ("copies of models", copies),
        ("copies in renderers", renderers),
        ("plans that are killed", kills),
        ("plans under Open Job Description", openjd),
    ];
    let mut failed = Vec::new();
    for (name, check) in checks {
        eprintln!("\n== {name}");
        if let Err(stop) = check(project, &tools) {
            eprintln!("{}", stop.sentence);
            failed.push(name);
        }
    }
    if failed.is_empty() {
        return Ok(());
    }
    Err(TaskError::failed(format!(
        "These checks failed: {}.",
        failed.join(", ")
    )))
}

type Check = fn(&Project, &Tools) -> Result<(), TaskError>;

/// Installed tools of others, and a folder to work in.
struct Tools {
    /// Interpreter with the Python packages.
    python: PathBuf,
    /// Interpreter with the renderers; `None` where these cannot be installed.
    renderers: Option<PathBuf>,
    node: PathBuf,
    /// Folder of the Node.js packages.
    packages: PathBuf,
    /// Scripts of the checks.
    scripts: PathBuf,
    work: PathBuf,
}

impl Tools {
    fn install(project: &Project) -> Result<Tools, TaskError> {
        let needed = |name: &str, package: &str| {
            program(name).ok_or_else(|| {
                let why = format!(
                    "The checks need {name}; install it, on Debian or Ubuntu with `apt-get install {package}`."
                );
                TaskError::new(2, why)
            })
        };
        let (python, node, npm) = (
            needed("python3", "python3-venv")?,
            needed("node", "nodejs")?,
            needed("npm", "npm")?,
        );
        let folder = project.target.join("interop");
        create_folder(&folder)?;
        let renderers = environment(project, &python, &folder.join("renderers"), &RENDERERS);
        if let Err(stop) = &renderers {
            eprintln!("No copy is drawn by other renderers. {}", stop.sentence);
        }
        let python = environment(project, &python, &folder.join("python"), &PYTHON_PACKAGES)?;
        let packages = folder.join("node");
        create_folder(&packages)?;
        let mut install = project.command(&npm)?;
        install
            .args(["install", "--silent", "--prefix"])
            .arg(&packages)
            .args(NODE_PACKAGES);
        finish(install, "Installing the Node.js packages")?;
        Ok(Tools {
            python,
            renderers: renderers.ok(),
            node,
            packages,
            scripts: project.root.join("crates/xtask/interop"),
            work: folder.join("work"),
        })
    }

    /// Runs a Python script of the checks.
    fn python(&self, project: &Project, script: &str, arguments: &[&Path]) -> Result<(), TaskError> {
        self.script(project, &self.python, script, arguments)
    }

    fn script(&self, project: &Project, python: &Path, script: &str, arguments: &[&Path]) -> Result<(), TaskError> {
        let mut command = project.command(python)?;
        command.arg(self.scripts.join(script)).args(arguments);
        finish(command, script)
    }

    /// Bakes into a folder inside of the working folder.
    fn bake(&self, project: &Project, graph: &str, model: &str, options: &[&str]) -> Result<PathBuf, TaskError> {
        let output = self.work.join(format!("{graph}-{model}-{}", options.join("")));
        let mut command = project.command(&project.sabi("release"))?;
        let graph = project.root.join("graphs/examples").join(graph);
        command
            .arg("bake")
            .arg(graph)
            .arg("--mesh")
            .arg(model_path(project, model));
        // Nothing reads the list of files that `sabi bake` prints.
        command.stdout(Stdio::null());
        command
            .args(["--size", "256", "--force", "--again", "--quiet", "-o"])
            .arg(&output)
            .args(options);
        finish(command, "A bake")?;
        Ok(output)
    }
}

/// Makes an environment of Python with packages, and returns its interpreter.
fn environment(project: &Project, python: &Path, folder: &Path, packages: &[&str]) -> Result<PathBuf, TaskError> {
    let mut make = project.command(python)?;
    make.args(["-m", "venv"]).arg(folder);
    finish(make, "Making an environment of Python")?;
    let python = folder.join("bin/python");
    let mut install = project.command(&python)?;
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    install.args(packages);
    finish(install, "Installing the Python packages")?;
    Ok(python)
}

fn model_path(project: &Project, model: &str) -> PathBuf {
    project.root.join("assets/meshes").join(model)
}

fn presets(project: &Project, tools: &Tools) -> Result<(), TaskError> {
    let arguments = [project.sabi("release"), tools.work.join("presets")];
    tools.python(project, "presets_read.py", &arguments.each_ref().map(PathBuf::as_path))
}

fn pictures(project: &Project, tools: &Tools) -> Result<(), TaskError> {
    let arguments = [project.sabi("release"), tools.work.join("pictures")];
    tools.python(
        project,
        "pictures_valid.py",
        &arguments.each_ref().map(PathBuf::as_path),
    )
}

fn renderers(project: &Project, tools: &Tools) -> Result<(), TaskError> {
    let Some(python) = &tools.renderers else {
        eprintln!("Left out.");
        return Ok(());
    };
    let arguments = [project.sabi("release"), tools.work.join("renderers")];
    let arguments = arguments.each_ref().map(PathBuf::as_path);
    tools.script(project, python, "renders_agree.py", &arguments)
}

fn reports(project: &Project, tools: &Tools) -> Result<(), TaskError> {
    let arguments = [project.sabi("release"), tools.work.join("reports")];
    tools.python(
        project,
        "reports_repeat.py",
        &arguments.each_ref().map(PathBuf::as_path),
    )
}

fn documents(project: &Project, tools: &Tools) -> Result<(), TaskError> {
    let mut folders = Vec::new();
    for (model, graph) in COPIES {
        let options = [
            "--preset",
            "materialx",
            "--preset",
            "usd",
            "--names",
            "$material_$preset_$map(.$udim)",
        ];
        folders.push(tools.bake(project, graph, model, &options)?);
    }
    let folders: Vec<&Path> = folders.iter().map(PathBuf::as_path).collect();
    tools.python(project, "materialx_valid.py", &folders)?;
    tools.python(project, "usd_valid.py", &folders)
}

fn copies(project: &Project, tools: &Tools) -> Result<(), TaskError> {
    let mut pairs = Vec::new();
    for (model, graph) in COPIES {
        for options in [vec!["--model"], vec!["--model", "--embed", "--preset", "gltf"]] {
            let copy = tools.bake(project, graph, model, &options)?.join(model);
            let mut pair = model_path(project, model).into_os_string();
            pair.push("=");
            pair.push(copy);
            pairs.push(pair);
        }
    }
    let mut command = project.command(&tools.node)?;
    command
        .arg(tools.scripts.join("gltf_valid.mjs"))
        .arg(&tools.packages)
        .args(pairs);
    finish(command, "gltf_valid.mjs")
}

fn kills(project: &Project, tools: &Tools) -> Result<(), TaskError> {
    let sabi = project.sabi("release");
    tools.python(project, "plan_kills.py", &[Path::new("--sabi"), &sabi])
}

fn openjd(project: &Project, tools: &Tools) -> Result<(), TaskError> {
    let (sabi, openjd) = (project.sabi("release"), tools.python.with_file_name("openjd"));
    let arguments = [Path::new("--sabi"), &sabi, Path::new("--openjd"), &openjd];
    tools.python(project, "openjd_run.py", &arguments)
}
