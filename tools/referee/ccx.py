"""Writes CalculiX input, runs ccx, reads its tables."""

import hashlib
import json
import os
import pathlib
import re
import subprocess

DENSITY = 1060.0  # [kg/m3], of every case
GRAVITY = 9.81  # [m/s2]

# ccx reads at most 20 characters of a number.
NUMBER = "{:.12e}"


class RefereeError(Exception):
    """Something to tell the user, without a traceback."""


def lame(young, poisson):
    """First Lame constant and shear modulus [Pa]."""
    mu = young / (2.0 * (1.0 + poisson))
    return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), mu


def stable_neo_hookean(young, poisson):
    """The energy that Sinew uses, exactly:

        W = mu/2 (I - 3) - mu (J - 1) + kappa/2 (J - 1)^2,   kappa = lambda + mu,  I = tr F^T F

    (Smith, de Goes, Kim 2018). CalculiX's foam of Ogden and Hill is

        W = sum_i 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3
                                      + (J^(-alpha_i beta_i) - 1) / beta_i).

    With alpha = 2 its terms are mu_i/2 (I - 3 + (J^(-2 beta_i) - 1) / beta_i). beta = -1/2 gives
    -2 (J - 1), beta = -1 gives 1 - J^2, and mu_1 = mu + kappa, mu_2 = -kappa add up to W. ccx wants
    nu_i with beta_i = nu_i / (1 - 2 nu_i): -1 is nu = 1, and -1/2 is the limit of a large nu.

    ccx takes the foam's stress from the principal stretches, which it finds to few digits where
    they are nearly equal: at strains of a percent and less its iterations end in that noise.
    """
    lam, mu = lame(young, poisson)
    kappa = lam + mu
    constants = [NUMBER.format(mu + kappa), "2.", NUMBER.format(-kappa), "2.", "1.e10", "1."]
    return f"*HYPERFOAM,N=2\n{','.join(constants)}\n"


def ciarlet(young, poisson):
    """W = mu/2 (I - 3) - mu ln J + lambda/4 (J^2 - 1 - 2 ln J), without that noise. It differs from
    the stable neo-Hookean energy by (lambda/6 + mu/3) (J - 1)^3 and higher orders, nothing that
    counts at small strains."""
    return f"*USER MATERIAL,CONSTANTS=2\n{young},{poisson}\n"


def linear_elastic(young, poisson):
    return f"*ELASTIC\n{young},{poisson}\n"


# Required residual, as a share of the mean force.
TOLERANCE = {stable_neo_hookean: 2e-3, ciarlet: 1e-6}


def section(law, young, poisson, elements="BODY"):
    """The material of a set of elements."""
    # ccx finds the law of a user material by its name.
    name = ("CIARLET_EL_" if law is ciarlet else "") + elements
    return (f"*MATERIAL,NAME={name}\n{law(young, poisson)}*DENSITY\n{DENSITY}\n"
            f"*SOLID SECTION,ELSET={elements},MATERIAL={name}\n")


def numbers(ids, per_line=12):
    """Ids as lines of an input file."""
    ids = [str(i) for i in ids]
    return "".join(",".join(ids[i:i + per_line]) + "\n" for i in range(0, len(ids), per_line))


def node_set(name, ids):
    return f"*NSET,NSET={name}\n" + numbers(ids)


def static_step(body, law, first=0.1, largest=0.25, solver=""):
    """One load step; `body` holds the loads and what to print. Times are shares of the step."""
    return (f"*STEP,NLGEOM,INC=2000\n*STATIC{',SOLVER=' * bool(solver)}{solver}\n"
            f"{first},1.,1e-7,{largest}\n"
            f"*CONTROLS,PARAMETERS=FIELD\n{TOLERANCE[law]},{TOLERANCE[law]}\n{body}*END STEP\n")


class Results:
    """The content of the .dat file of ccx."""

    HEAD = re.compile(r"^ (\S.*?) \(.*\) for set (\S+) and time +(\S+)\s*$")
    TOTAL = re.compile(r"^ total force \(fx,fy,fz\) for set (\S+) and time +(\S+)\s*$")

    def __init__(self, text):
        self.text = text

    def last(self, kind, name):
        """The last table of 'displacements' or 'forces' for a set: {node: (x, y, z)}."""
        table, found = {}, False
        lines = iter(self.text.splitlines())
        for line in lines:
            head = self.HEAD.match(line)
            if head:
                found = head.group(1) == kind and head.group(2) == name.upper()
                table = {} if found else table
            elif found and line.strip():
                fields = line.split()
                table[int(fields[0])] = tuple(float(f) for f in fields[1:4])
        if not table:
            raise RefereeError(f"ccx printed no {kind} of {name}")
        return table

    def frequencies(self):
        """The eigenfrequencies [Hz], in order."""
        rows = re.findall(r"^ +\d+ +(\S+) +(\S+) +(\S+) +(\S+)\s*$", self.text.split(
            "E I G E N V A L U E   O U T P U T")[1].split("P A R T I C I P A T I O N")[0],
            re.MULTILINE)
        return [float(row[2]) for row in rows]


class Runner:
    """Runs ccx in a folder and keeps what it has run: the same input is not run twice."""

    def __init__(self, folder, program="ccx", say=print):
        self.folder = pathlib.Path(folder).resolve()
        self.program = program
        self.say = say

    def run(self, name, deck):
        """Runs one deck to its end. RefereeError where ccx gives up."""
        folder = self.folder / name
        folder.mkdir(parents=True, exist_ok=True)
        job, mark = folder / "job.inp", folder / "finished"
        digest = hashlib.sha256(deck.encode()).hexdigest()
        if not mark.exists() or mark.read_text() != digest:
            mark.unlink(missing_ok=True)
            job.write_text(deck)
            self.say(f"  ccx {name}")
            with open(folder / "log.txt", "w", encoding="utf-8") as log:
                status = subprocess.run(["nice", "-n", "19", self.program, "job"], cwd=folder,
                                        stdout=log, stderr=log, check=False,
                                        env={**os.environ, "OMP_NUM_THREADS": "1"}).returncode
            text = (folder / "log.txt").read_text(errors="replace")
            if status != 0 or "*ERROR" in text or "Job finished" not in text:
                reason = re.findall(r"\*ERROR.*(?:\n +.*)?", text)
                raise RefereeError(f"ccx failed on {name}: " +
                                   " ".join((reason or ["see log.txt"])[-1].split()))
            mark.write_text(digest)
        return Results((folder / "job.dat").read_text())

    def remember(self, name, function):
        """The result of function() at its first call under this name: a list of numbers."""
        path = self.folder / f"{name}.json"
        if not path.exists():
            self.say(f"  fem {name}")
            path.write_text(json.dumps([float(v) for v in function()]))
        return json.loads(path.read_text())
