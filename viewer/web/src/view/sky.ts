import {BufferAttribute, BufferGeometry, Matrix4, Mesh, ShaderMaterial, type Camera} from 'three';
import {kSkyColor} from './terrain_shader';
import type {SharedUniforms} from './terrain_material';

// one triangle over the whole picture, behind everything: drawn last, only where no terrain is
const kVertexShader = /* glsl */ `
  uniform mat4 toWorld;
  varying vec3 vDirection;
  void main() {
    vec4 far = toWorld * vec4(position.xy, 1.0, 1.0);
    vDirection = far.xyz / far.w;
    gl_Position = vec4(position.xy, 1.0, 1.0);
  }
`;

// a grain of less than a step of 8 bits: no bands in a clear sky
const kFragmentShader = /* glsl */ `
  varying vec3 vDirection;
  ${kSkyColor}
  void main() {
    float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    gl_FragColor = vec4(skyColor(normalize(vDirection)) + (grain - 0.5) / 255.0, 1.0);
  }
`;

/** The sky behind the terrain. */
export class Sky {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly toWorld = new Matrix4();

  constructor(shared: SharedUniforms) {
    const geometry = new BufferGeometry();
    const corners = new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]);
    geometry.setAttribute('position', new BufferAttribute(corners, 3));
    const {horizon, zenith, sun, sunlight, sunGlow} = shared;
    const material = new ShaderMaterial({
      vertexShader: kVertexShader,
      fragmentShader: kFragmentShader,
      uniforms: {horizon, zenith, sun, sunlight, sunGlow, toWorld: {value: this.toWorld}},
      depthWrite: false,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = Infinity;
  }

  /** @param camera at the place and with the lens of the picture */
  aim(camera: Camera): void {
    const rotation = new Matrix4().extractRotation(camera.matrixWorld);
    this.toWorld.multiplyMatrices(rotation, camera.projectionMatrixInverse);
  }
}
