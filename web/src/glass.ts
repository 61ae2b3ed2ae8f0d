// A transparent material: clear where it faces the viewer, denser towards its rim.
import * as THREE from "three";

const RIM = 1.4; // sharpness of the rim

// Depth offset for coincident surfaces, which would otherwise show in patches.
const IN_FRONT = { polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4 };

export interface GlassOptions {
  color?: number;
  vertexColors?: boolean;
  clear: number; // opacity where it faces the viewer
  rim: number; // and at its rim
  /** Offset towards the viewer in depth comparisons [m]. */
  nearer?: { value: number };
}

export function glass({ color = 0xffffff, vertexColors = false, clear, rim, nearer = { value: 0 } }: GlassOptions): THREE.MeshPhysicalMaterial {
  const material = new THREE.MeshPhysicalMaterial({
    color,
    vertexColors,
    transparent: true,
    depthWrite: false,
    ...IN_FRONT,
    roughness: 0.35,
    clearcoat: 0.5,
    clearcoatRoughness: 0.3,
    shadowSide: THREE.BackSide,
  });
  material.onBeforeCompile = (shader) => {
    pull(shader, nearer);
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <opaque_fragment>",
      `float toViewer = abs(dot(normalize(vViewPosition), normal));
       diffuseColor.a = mix(${clear.toFixed(3)}, ${rim.toFixed(3)}, pow(1.0 - min(toViewer, 1.0), ${RIM.toFixed(3)}));
       #include <opaque_fragment>`,
    );
  };
  material.customProgramCacheKey = () => `glass ${clear} ${rim}`;
  return material;
}

/** Drawn before the glass itself, so that only its nearest side is visible. */
export function nearestOnly(nearer = { value: 0 }): THREE.MeshBasicMaterial {
  // Sorted with the transparent objects; otherwise opaque objects behind it would not be drawn.
  const material = new THREE.MeshBasicMaterial({ colorWrite: false, transparent: true, ...IN_FRONT });
  material.onBeforeCompile = (shader) => pull(shader, nearer);
  material.customProgramCacheKey = () => "nearest only";
  return material;
}

/** Changes only the depth, not the position in the image. */
function pull(shader: THREE.WebGLProgramParametersWithUniforms, nearer: { value: number }): void {
  shader.uniforms.nearer = nearer;
  shader.vertexShader = `uniform float nearer;\n${shader.vertexShader.replace(
    "#include <project_vertex>",
    `#include <project_vertex>
     vec4 pulled = projectionMatrix * (mvPosition + vec4(0.0, 0.0, nearer, 0.0));
     gl_Position.z = pulled.z / pulled.w * gl_Position.w;`,
  )}`;
}

export const GLASS_ORDER = 3; // after grid and lines
