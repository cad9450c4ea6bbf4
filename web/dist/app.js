"use strict";(()=>{var oe,fu,Yi,Pn,ji,pl,pu,cl,du,Ki,qi,Ud,bo=Symbol.for("pv"),dl={},ml=[],Wd=/^m(i|n|o|s|text|space)$/,Zi=Array.isArray,Ji=ml.
slice,Jn=Object.assign;function Zn(e){e&&e.parentNode&&e.remove()}function mu(e,t,n){var r,o,l,a={},c=arguments.length;for(l in t)
l=="key"?r=t[l]:l=="ref"&&typeof e!="function"?o=t[l]:a[l]=t[l];return c>2&&(a.children=c>3?Ji.call(arguments,2):n),_o(e,
a,r,o,null)}function _o(e,t,n,r,o){var l={type:e,props:t,key:n,ref:r,__k:null,__:null,__b:0,__e:null,__c:null,constructor:bo,__v:o||
++fu,__i:-1,__u:0};return!o&&oe.vnode&&oe.vnode(l),l}function te(e){return e.children}function Dr(e,t){this.props=e,this.context=t,this.__g=0}function On(e,t){if(t==null)return e.
__&&On(e.__,e.__i+1);for(var n;t<e.__k.length;t++)if((n=e.__k[t])&&n.__e)return n.__e;return typeof e.type!="function"||
e.props.__P?null:On(e)}function Gd(e){var t,n=e.__v,r=n.__e,o=[],l=[],a=e.__P;a&&((t=Jn({constructor:bo},n)).__v=n.__v+1,
oe.vnode&&oe.vnode(t),Xi(a,t,n,e.__n,a.namespaceURI,32&n.__u?[r]:null,o,r||On(n),32&n.__u,l),t.__v=n.__v,t.__.__k[t.__i]=
t,xu(o,t,l),n.__=n.__e=null,t.__e!=r&&hu(t))}function hu(e){if((e=e.__)&&e.__c&&!e.props.__P)return e.__e=null,e.__k.some(
function(t){return t&&(e.__e=t.__e)}),hu(e)}function uu(e){(8&e.__g||(e.__g|=8,Pn.push(e),pl++))&&ji==oe.debounceRendering||
((ji=oe.debounceRendering)||queueMicrotask)(gu)}function gu(){try{for(var e,t=1;Pn.length;)Pn.length>t&&Pn.sort(pu),e=Pn.
shift(),t=Pn.length,8&e.__g&&Gd(e)}finally{(pl=Pn.length)&&(ji||queueMicrotask)(gu)}}function vu(e,t,n,r,o,l,a,c,d,m,g){
var _,x,v,k,N,A,F=r.__k||ml,w=t.length;for(d=Bd(n,t,F,d,w),_=0;_<w;_++)(v=n.__k[_])!=null&&(x=~v.__i&&F[v.__i]||dl,v.__i=
_,A=Xi(e,v,x,o,l,a,c,d,m,g),k=v.__e,(x.ref!=v.ref||8&x.__u)&&(x.ref&&Qi(x.ref,null,v,x),v.ref&&g.push(v.ref,v.__c||k,v)),
N=N||k,4&v.__u?(d=_u(v,d,e,!x.__v),x.__e&&(x.__e=null)):typeof v.type=="function"&&A!==void 0?d=A:k&&(d=k.nextSibling),v.
__u&=-21);return n.__e=N,d}function Bd(e,t,n,r,o){var l,a,c,d,m,g,_,x,v,k=n.length,N=k,A=0,F=0,w=e.__k=Array(o);for(l=0;l<
o;l++)(a=t[l])!=null&&typeof a!="boolean"&&typeof a!="function"?(typeof a!="object"||a.constructor===String?a=w[l]=_o(null,
a):Zi(a)?a=w[l]=_o(te,{children:a}):a.constructor===bo&&a.__b?a=w[l]=_o(a.type,a.props,a.key,a.ref,a.__v):w[l]=a,d=l+A,a.
__=e,a.__b=e.__b+1,c=null,~(m=a.__i=jd(a,n,d,N))&&(N--,(c=n[m])&&(c.__u|=2)),c&&c.__v?(a.__u|=16,m==d-1?A--:m==d+1?A++:m!=
d&&(m>d?A--:A++,F=1)):(~m||(o>k?A--:o<k&&A++),typeof a.type!="function"&&(a.__u|=4))):w[l]=null;if(F){for(g=[],_=[],l=0;l<
o;l++)if((a=w[l])&&16&a.__u){for(A=0,x=g.length;A<x;)g[v=A+x>>1]<a.__i?A=v+1:x=v;g[A]=a.__i,_[l]=A+1}for(A=g.length;l--;)
_[l]&&(_[l]==A?A--:w[l].__u|=4)}if(N)for(l=0;l<k;l++)!(c=n[l])||2&c.__u||(c.__e==r&&(r=On(c)),es(c,c));return r}function _u(e,t,n,r){
var o,l,a,c;if(typeof e.type=="function"){if(e.props.__P)return t;if(o=e.__k)for(l=0;l<o.length;l++)o[l]&&(o[l].__=e,t=_u(
o[l],t,n,!1));return t}for(t&&!t.parentNode&&(t=On(e))&&!t.parentNode&&(t=null),a=e.__e,c=t;c&&c.nodeType==8;)c=c.nextSibling;
for(a!=c&&(!r&&n.moveBefore&&a.parentNode?n.moveBefore(a,t):n.insertBefore(a,t||null)),t=a;(t=t&&t.nextSibling)&&t.nodeType==
8&&!t.data.startsWith("$s"););return t}function jd(e,t,n,r){var o,l=e.key,a=e.type,c=t[n],d=c&&!(2&c.__u);if(c===null&&l==null||d&&l==c.key&&a==c.type)return n;
if(r>(d?1:0)){for(o=n-1;o>=0;o--)if((c=t[o])&&!(2&c.__u)&&l==c.key&&a==c.type)return o;for(o=n+1;o<t.length;o++)if((c=t[o])&&
!(2&c.__u)&&l==c.key&&a==c.type)return o}return-1}function cu(e,t,n){n==null&&(n=""),t[0]=="-"?e.setProperty(t,n):e[t]=n}
function ul(e,t,n,r,o){var l,a;if(t=="style")if(typeof n=="string")e.style.cssText=n;else{if(typeof r=="string"&&(e.style.
cssText=r=""),r)for(t in r)n&&t in n||cu(e.style,t);if(n)for(t in n)r&&n[t]==r[t]||cu(e.style,t,n[t])}else if(t[0]=="o"&&
t[1]=="n")typeof n!="function"&&(n=null),typeof r!="function"&&(r=null),(e.__e||(e.__e={}))[t]=n,n&&r||(a=qi[t]||(qi[t]=
qd(t)),(e.__a||(e.__a={}))[t]=Ki,l=t!=(t=t.replace(du,"$1")),(t=t.slice(2))[0]<"a"&&(t=t.toLowerCase()),n?e.addEventListener(
t,a,l):e.removeEventListener(t,a,l));else{if(o=="http://www.w3.org/2000/svg")t=t.replace(/xlink(H|:h)/,"h").replace(/sName$/,
"s");else if(t!="width"&&t!="height"&&t!="href"&&t!="list"&&t!="form"&&t!="tabIndex"&&t!="download"&&t!="rowSpan"&&t!="c\
olSpan"&&t!="role"&&t!="popover"&&t in e)try{return void(e[t]=n??"")}catch{}if(typeof n=="function")return;n==null||n===
!1&&t[4]!="-"?e.removeAttribute(t):e.setAttribute(t,t=="popover"&&n==1?"":n)}}function qd(e){return function(t){var n=this.
__e;if(n){if(n=n[e],t[cl]==null)t[cl]=Ki++;else if(t[cl]<this.__a[e])return;return n(oe.event?oe.event(t):t)}}}function Xi(e,t,n,r,o,l,a,c,d,m){
var g,_,x,v,k,N,A,F,w,P,S,K,$,Z,G,X,W,E,B=t.type;if(t.constructor!==bo)return null;128&n.__u&&(d=32&n.__u,g=n.__c.__z)&&
(t.__u|=d,_=l=[],g.nodeType==8?c=fl(g,l):l.push(g),c=l[0]||c),(g=oe.__b)&&g(t);e:if(typeof B=="function"){x=a.length;try{
if(F=t.props,w=(g=B.prototype)&&g.render,P=(g=B.contextType)&&r[g.__c],S=g?P?P.props.value:g.__:r,(v=n.__c)?(t.__c=v,2&v.
__g&&(v.__g|=1)):(w?t.__c=v=new B(F,S):(t.__c=v=new Dr(F,S),v.constructor=B,v.render=Kd),P&&P.sub(v),v.state||(v.state={}),
v.__n=r,v.__g|=8,v.__h=[],v.__k=[]),w&&(v.__s||(v.__s=v.state),B.getDerivedStateFromProps&&(v.__s==v.state&&(v.__s=Jn({},
v.__s)),Jn(v.__s,B.getDerivedStateFromProps(F,v.__s)))),k=v.props,N=v.state,v.__v=t,n.__c){if(F!==k&&w&&!B.getDerivedStateFromProps&&
v.componentWillReceiveProps&&v.componentWillReceiveProps(F,S),t.__v==n.__v&&!(8&v.__g)||!(4&v.__g)&&v.shouldComponentUpdate&&
v.shouldComponentUpdate(F,v.__s,S)===!1){t.__v!=n.__v&&(v.props=F,v.state=v.__s,v.__g&=-9),t.__e=n.__e,t.__k=n.__k,t.__k.
some(function(C){C&&(C.__=t)}),ml.push.apply(v.__h,v.__k),v.__k=[],v.__h.length&&a.push(v),c=On(n);break e}v.componentWillUpdate&&
v.componentWillUpdate(F,v.__s,S),w&&v.componentDidUpdate&&v.__h.push(function(){v.componentDidUpdate(k,N,A)})}else w&&!B.
getDerivedStateFromProps&&v.componentWillMount&&v.componentWillMount(),w&&v.componentDidMount&&v.__h.push(v.componentDidMount);
v.context=S,v.props=F,v.__P=e,v.__g&=-5,K=oe.__r,$=w?25:0;do v.__g&=-9,K&&K(t),g=v.render(v.props,v.state=v.__s,v.context);while(8&
v.__g&&++$<25);w&&(ml.push.apply(v.__h,v.__k),v.__k=[]),v.state=v.__s,v.getChildContext&&(r=Jn({},r,v.getChildContext())),
w&&n.__c&&v.getSnapshotBeforeUpdate&&(A=v.getSnapshotBeforeUpdate(k,N)),Z=g&&g.type===te&&g.key==null?g.props.children:g,
F.__P&&(g=c,o=(e=F.__P).namespaceURI,d=l=null,n.props&&n.props.__P!=e&&(n.__k.some(function(C){C&&es(C,C)}),n.__k=null),
c=n.__k?On(n,0):null),c=vu(e,Zi(Z)?Z:[Z],t,n,r,o,l,a,c,d,m),F.__P&&(t.__e=null,c=g),t.__u&=-161,_&&_.some(Zn),v.__h.length&&
a.push(v),1&v.__g&&(v.__g&=-4)}catch(C){if(a.length=x,t.__v=null,d||l)if(C&&C.then){if(t.__u|=128|d,l){for(~(W=l.indexOf(
c||void 0))||(W=l.length);(E=l[W-1])&&E.nodeType==8;)W--;for(;W<l.length;W++)if(E=l[W])if(l[W]=null,G){if(E==X)break}else{
if(E.nodeType!=8)break;E.data.startsWith("$s")&&(X=fl(G=E))}}if(!G){for(;c&&c.nodeType==8&&c.nextSibling;)c=c.nextSibling;
G=c}(g=fl(G=t.__c.__z||(t.__c.__z=G)))?(t.__e=G,c=g):t.__e=c,c=c&&c.nextSibling}else l&&l.some(Zn);else t.__e=n.__e;t.__k||
(t.__k=n.__k||[]),C&&C.then||bu(t),oe.__e(C,t,n)}}else c=t.__e=Yd(n.__e,t,n,r,o,l,a,d,m,e);return(g=oe.diffed)&&g(t),c}function fl(e,t){
if(e&&e.nodeType==8&&e.data.startsWith("$s"))for(var n=1;e=e.nextSibling;){if(e.nodeType==8){if(e.data.startsWith("$s"))
n++;else if(e.data.startsWith("/$s")&&!--n)return e}t&&t.push(e)}}function bu(e){e&&(e.__c&&(e.__c.__g|=4),e.__k&&e.__k.
some(bu))}function xu(e,t,n){for(var r=0;r<n.length;)Qi(n[r++],n[r++],n[r++]);oe.__c&&oe.__c(t,e),e.some(function(o){try{
e=o.__h,o.__h=[],e.some(function(l){l.call(o)})}catch(l){oe.__e(l,o.__v)}})}function Yd(e,t,n,r,o,l,a,c,d,m){var g,_,x,v,
k,N,A,F,w=n.props||dl,P=t.props,S=t.type;if(S=="svg"?o="http://www.w3.org/2000/svg":S=="math"?o="http://www.w3.org/1998/\
Math/MathML":o||(o="http://www.w3.org/1999/xhtml"),l){for(g=0;g<l.length;g++)if((k=l[g])&&(S?k.localName==S:k.nodeType==
3)){e=k,l[g]=null;break}}if(!e){if(F=m.ownerDocument||document,!S)return F.createTextNode(P);e=F.createElementNS(o,S,P.is?
P:m),c&&(oe.__m&&oe.__m(t,l),c=!1),l=null}if(S){if(m=S=="template"&&e.content||e,l=S=="textarea"&&P.defaultValue!=null?null:
l&&Ji.call(m.childNodes),!c&&l)for(w={},g=0;g<e.attributes.length;g++)w[(k=e.attributes[g]).name]=k.value;for(g in w)k=w[g],
g=="dangerouslySetInnerHTML"?x=k:g=="children"||g in P||g=="value"&&"defaultValue"in P||g=="checked"&&"defaultChecked"in
P||ul(e,g,null,k,o);for(g in P)k=P[g],g=="children"?v=k:g=="dangerouslySetInnerHTML"?_=k:g=="value"?N=k:g=="checked"?A=k:
c&&typeof k!="function"||w[g]===k||ul(e,g,k,w[g],o);_?(c||x&&(_.__html==x.__html||_.__html==e.innerHTML)||(e.innerHTML=_.
__html),t.__k=[]):(x&&(e.textContent=""),(S=="foreignObject"||o=="http://www.w3.org/1998/Math/MathML"&&Wd.test(S))&&(o="\
http://www.w3.org/1999/xhtml"),vu(m,Zi(v)?v:[v],t,n,r,o,l,a,l?l[0]:n.__k&&On(n,0),c,d),l&&l.some(Zn)),c&&S!="textarea"||
(g="value",S=="progress"&&N==null?e.removeAttribute(g):N==null||N===e[g]&&(S!="progress"||N)||ul(e,g,N,w[g],o),g="checke\
d",A!=null&&A!=e[g]&&ul(e,g,A,w[g],o))}else w===P||c&&e.data==P||(e.data=P);return e}function Qi(e,t,n,r){try{typeof e==
"function"?t?t.__x=e(t)||1:r&&(r=r.__c||r.__e)&&(t=r.__x)&&(r.__x=null,typeof t=="function"?t():e(null)):e.current=t}catch(o){
oe.__e(o,n)}}function es(e,t,n){var r,o,l,a;if(oe.unmount&&oe.unmount(e),!(r=e.ref)||r.current&&r.current!=e.__e||Qi(r,null,
t,e),r=e.__c){if(r.componentWillUnmount)try{r.componentWillUnmount()}catch(c){oe.__e(c,t)}r.__P=r.__n=null}if(r=e.__k)for(a=
0;a<r.length;a++)r[a]&&es(r[a],t,typeof e.type!="function"||n&&!e.props.__P);!n&&(r=e.__c)&&(r=r.__z)&&(o=fl(r,l=[]))&&(r==
e.__e&&l.some(Zn),Zn(o),Zn(r)),n||Zn(e.__e),e.__e=e.__c=e.__=null}function Kd(e,t,n){return this.constructor(e,n)}function wu(e,t){
var n,r,o,l;oe.__&&oe.__(e,t),t.nodeType==9&&(t=t.documentElement),r=(n=e&&32&e.__u)?null:t.__k,t.__k=_o(te,{children:[e]}),
o=[],l=[],Xi(t,t.__k,r||dl,dl,t.namespaceURI,r?null:t.firstChild?Ji.call(t.childNodes):null,o,r?r.__e:t.firstChild,n,l),
xu(o,t.__k,l),t.__k.props.children=null}oe={__e:function(e,t,n,r){for(var o,l,a;t=t.__;)if((o=t.__c)&&!(1&o.__g)){o.__g|=4;try{if((a=(l=o.constructor)&&l.getDerivedStateFromError)&&
o.setState(l.getDerivedStateFromError(e)),o.componentDidCatch&&(o.componentDidCatch(e,r||{}),a=1),a&&8&o.__g)return void(o.
__g|=2)}catch(c){e=c}}throw pl=0,e}},fu=0,Yi=function(e){return e!=null&&e.constructor===bo},Dr.prototype.setState=function(e,t){
var n=this.__s;n&&n!=this.state||(n=this.__s=Jn({},this.state)),typeof e=="function"&&(e=e(Jn({},n),this.props)),e&&(Jn(
n,e),this.__v&&(t&&this.__k.push(t),uu(this)))},Dr.prototype.forceUpdate=function(e){this.__v&&(this.__g|=4,e&&this.__h.
push(e),uu(this))},Dr.prototype.render=te,Pn=[],pl=0,pu=function(e,t){return e.__v.__b-t.__v.__b},cl=Symbol(),du=/(PointerCapture)$|Capture$/i,
Ki=0,qi={},Ud=0;var Lr,De,ts,yu,ns=Object.is,hl=0,Ou=[],rs=[],Fe=oe,Su=Fe.__b,ku=Fe.__r,Mu=Fe.diffed,Tu=Fe.__c,Eu=Fe.unmount,Au=Fe.__;function gl(e,t){
Fe.__h&&Fe.__h(De,e,hl||t),hl=0;var n=De.__H||(De.__H={__:[],__h:[]});return e>=n.__.length&&n.__.push({}),n.__[e]}function Fu(e){
return hl=1,Zd(Cu,e)}function Zd(e,t,n){var r=gl(Lr++,2);if(r.t=e,!r.__c&&(r.__=[n?n(t):Cu(void 0,t),function(l){var a=(r.
__N||r.__)[0],c=r.t(a,l);ns(a,c)||(r.__N=[c,r.__[1]],r.__c.setState({}))}],r.__c=De,!De.__f)){De.__f=!0;var o=De.shouldComponentUpdate;
De.shouldComponentUpdate=function(l,a,c){var d=this.__H;if(!d)return!0;var m=!1,g=this.props!=l;if(d.__.some(function(x){
x.__N&&(m=!0,ns(x.__[0],x.__N[0])||(g=!0))}),o){var _=o.call(this,l,a,c);return m?_||g:_}return!m||g}}return r.__}function Qe(e,t){
var n=gl(Lr++,3);!Fe.__s&&ls(n.__H,t)&&(n.__P=!0,n.__=e,n.u=t,De.__H.__h.push(n))}function $r(e,t){var n=gl(Lr++,4);!Fe.
__s&&ls(n.__H,t)&&(n.__P=!1,n.__=e,n.u=t,De.__h.push(n))}function $t(e){return hl=5,vl(function(){return{current:e}},[])}function vl(e,t){var n=gl(Lr++,7);return ls(n.__H,t)&&(n.__=e(),n.__H=t),n.__}function Jd(){var e;do{for(;e=rs.shift();)try{xo(e)}catch(n){Fe.__e(n,{__:(e=e.__P)&&e.__v})}for(;e=Ou.shift();){var t=e.
__H;if(e.__P&&t)try{t.__h.some(xo),t.__h.some(os),t.__h=[]}catch(n){t.__h=[],Fe.__e(n,e.__v)}}}while(rs.length)}Fe.__b=function(e){
De=null,Su&&Su(e)},Fe.__=function(e,t){e&&t.__k&&t.__k.__m&&(e.__m=t.__k.__m),Au&&Au(e,t)},Fe.__r=function(e){ku&&ku(e),
Lr=0;var t=(De=e.__c).__H;t&&(ts==De?De.__h=[]:(t.__h.some(xo),t.__h.some(os),Lr=0),t.__h=[],t.__.some(function(n){n.__N&&
(n.__=n.__N),n.u=n.__N=void 0})),ts=De},Fe.diffed=function(e){Mu&&Mu(e);var t=e.__c;t&&t.__H&&(t.__H.__h.length&&Pu(Ou.push(
t)),t.__H.__.some(function(n){n.u&&(n.__H=n.u)})),ts=De=null},Fe.__c=function(e,t){t.some(function(n){try{n.__h.some(xo),
n.__h=n.__h.filter(function(r){return!r.__||os(r)})}catch(r){n.__h=[function(){throw r}]}}),Tu&&Tu(e,t)},Fe.unmount=function(e){
Eu&&Eu(e);var t,n,r=e.__c;r&&r.__H&&(r.__H.__.some(function(o){try{if(o.__P&&o.__c){if(n===void 0){for(n=e.__;n&&(!n.__c||
!n.__c.__P);)n=n.__;n=n&&n.__c}o.__P=n,Pu(rs.push(o))}else xo(o)}catch(l){t=l}}),r.__H=void 0,t&&Fe.__e(t,r.__v))};var Nu=typeof requestAnimationFrame==
"function";function Xd(e){var t,n=function(){clearTimeout(r),Nu&&cancelAnimationFrame(t),setTimeout(e)},r=setTimeout(n,35);
Nu&&(t=requestAnimationFrame(n))}function Pu(e){e!=1&&yu==Fe.requestAnimationFrame||((yu=Fe.requestAnimationFrame)||Xd)(
Jd)}function xo(e){var t=De,n=e.__c;typeof n=="function"&&(e.__c=void 0,n()),De=t}function os(e){var t=De;e.__c=e.__(),De=
t}function ls(e,t){return!e||e.length!=t.length||t.some(function(n,r){return!ns(n,e[r])})}function Cu(e,t){return typeof t==
"function"?t(e):t}var Qd=Symbol.for("preact-signals");function wl(){if(gn>1)gn--;else{var e,t=!1;for((function(){var o=bl;for(bl=void 0;o!==
void 0;){var l=o.S;if(l.v===o.v)for(var a=l.t;a!==void 0;a=a.x)a.i===o.i&&(a.i=l.i);o=o.o}})();yo!==void 0;){var n=yo;for(yo=
void 0,_l++;n!==void 0;){var r=n.u;if(n.u=void 0,n.f&=-3,!(8&n.f)&&Lu(n))try{n.c()}catch(o){t||(e=o,t=!0)}n=r}}if(_l=0,gn--,
t)throw e}}function un(e){if(gn>0)return e();is=++em,gn++;try{return e()}finally{wl()}}var wo,Ee=void 0;function So(e){var t=Ee,
n=wo;Ee=void 0,wo=void 0;try{return e()}finally{Ee=t,wo=n}}var yo=void 0,gn=0,_l=0,em=0,is=0,bl=void 0,xl=0;function Du(e){
if(Ee!==void 0){var t=e.n;if(t===void 0||t.t!==Ee)return t={i:0,S:e,p:Ee.s,n:void 0,t:Ee,e:void 0,x:void 0,r:t},Ee.s!==void 0&&
(Ee.s.n=t),Ee.s=t,e.n=t,32&Ee.f&&e.S(t),t;if(t.i===-1)return t.i=0,t.n!==void 0&&(t.n.p=t.p,t.p!==void 0&&(t.p.n=t.n),t.
p=Ee.s,t.n=void 0,Ee.s.n=t,Ee.s=t),t}}function ze(e,t){this.v=e,this.i=0,this.n=void 0,this.t=void 0,this.l=0,this.W=t?.
watched,this.Z=t?.unwatched,this.name=t?.name}ze.prototype.brand=Qd;ze.prototype.h=function(){return!0};ze.prototype.S=function(e){
var t=this,n=this.t;n!==e&&e.e===void 0&&(e.x=n,this.t=e,n!==void 0?n.e=e:So(function(){var r;(r=t.W)==null||r.call(t)}))};
ze.prototype.U=function(e){var t=this;if(this.t!==void 0){var n=e.e,r=e.x;n!==void 0&&(n.x=r,e.e=void 0),r!==void 0&&(r.
e=n,e.x=void 0),e===this.t&&(this.t=r,r===void 0&&So(function(){var o;(o=t.Z)==null||o.call(t)}))}};ze.prototype.subscribe=
function(e){var t=this;return Le(function(){var n=t.value;So(function(){return e(n)})},{name:"sub"})};ze.prototype.valueOf=
function(){return this.value};ze.prototype.toString=function(){return this.value+""};ze.prototype.toJSON=function(){return this.
value};ze.prototype.peek=function(){var e=this;return So(function(){return e.value})};Object.defineProperty(ze.prototype,
"value",{get:function(){var e=Du(this);return e!==void 0&&(e.i=this.i),this.v},set:function(e){if(e!==this.v){if(_l>100)
throw new Error("Cycle detected");(function(n){gn!==0&&_l===0&&n.l!==is&&(n.l=is,bl={S:n,v:n.v,i:n.i,o:bl})})(this),this.
v=e,this.i++,xl++,gn++;try{for(var t=this.t;t!==void 0;t=t.x)t.t.N()}finally{wl()}}}});function I(e,t){return new ze(e,t)}
function Lu(e){for(var t=e.s;t!==void 0;t=t.n)if(t.S.i!==t.i||!t.S.h()||t.S.i!==t.i)return!0;return!1}function $u(e){for(var t=e.
s;t!==void 0;t=t.n){var n=t.S.n;if(n!==void 0&&(t.r=n),t.S.n=t,t.i=-1,t.n===void 0){e.s=t;break}}}function Ru(e){for(var t=e.
s,n=void 0;t!==void 0;){var r=t.p;t.i===-1?(t.S.U(t),r!==void 0&&(r.n=t.n),t.n!==void 0&&(t.n.p=r)):n=t,t.S.n=t.r,t.r!==
void 0&&(t.r=void 0),t=r}e.s=n}function Xn(e,t){ze.call(this,void 0,t),this.x=e,this.s=void 0,this.g=xl-1,this.f=4}Xn.prototype=
new ze;Xn.prototype.h=function(){if(this.f&=-3,1&this.f)return!1;if((36&this.f)==32||(this.f&=-5,this.g===xl))return!0;if(this.
g=xl,this.f|=1,this.i>0&&!Lu(this))return this.f&=-2,!0;var e=Ee;try{$u(this),Ee=this;var t=this.x();(16&this.f||this.v!==
t||this.i===0)&&(this.v=t,this.f&=-17,this.i++)}catch(n){this.v=n,this.f|=16,this.i++}return Ee=e,Ru(this),this.f&=-2,!0};
Xn.prototype.S=function(e){if(this.t===void 0){this.f|=36;for(var t=this.s;t!==void 0;t=t.n)t.S.S(t)}ze.prototype.S.call(
this,e)};Xn.prototype.U=function(e){if(this.t!==void 0&&(ze.prototype.U.call(this,e),this.t===void 0)){this.f&=-33;for(var t=this.
s;t!==void 0;t=t.n)t.S.U(t)}};Xn.prototype.N=function(){if(!(2&this.f)){this.f|=6;for(var e=this.t;e!==void 0;e=e.x)e.t.
N()}};Object.defineProperty(Xn.prototype,"value",{get:function(){if(1&this.f)throw new Error("Cycle detected");var e=Du(
this);if(this.h(),e!==void 0&&(e.i=this.i),16&this.f)throw this.v;return this.v}});function mt(e,t){return new Xn(e,t)}function Iu(e){
var t=e.j;if(e.j=void 0,typeof t=="function"){gn++;var n=Ee;Ee=void 0;try{t()}catch(r){throw e.f&=-2,e.f|=8,ss(e),r}finally{
Ee=n,wl()}}}function ss(e){for(var t=e.s;t!==void 0;t=t.n)t.S.U(t);e.x=void 0,e.s=void 0,Iu(e)}function tm(e){if(Ee!==this)
throw new Error("Out-of-order effect");Ru(this),Ee=e,this.f&=-2;try{8&this.f&&ss(this)}finally{wl()}}function Rr(e,t){this.
x=e,this.j=void 0,this.s=void 0,this.u=void 0,this.f=32,this.name=t?.name,wo&&wo.push(this)}Rr.prototype.c=function(){var e=this.
S();try{if(8&this.f||this.x===void 0)return;var t=this.x();typeof t=="function"&&(this.j=t)}finally{e()}};Rr.prototype.S=
function(){if(1&this.f)throw new Error("Cycle detected");this.f|=1,this.f&=-9,Iu(this),$u(this),gn++;var e=Ee;return Ee=
this,tm.bind(this,e)};Rr.prototype.N=function(){2&this.f||(this.f|=2,this.u=yo,yo=this)};Rr.prototype.d=function(){this.
f|=8,1&this.f||ss(this)};Rr.prototype.dispose=function(){this.d()};function Le(e,t){var n=new Rr(e,t);try{n.c()}catch(o){
throw n.d(),o}var r=n.d.bind(n);return r[Symbol.dispose]=r,r}var Vu,Sl,yl,nm=typeof window<"u"&&!!window.__PREACT_SIGNALS_DEVTOOLS__;var zu=[];Le(function(){Vu=this.N})();function Ir(e,t){oe[e]=t.bind(null,oe[e]||function(){})}function ko(e){if(yl){var t=yl;
yl=void 0,t()}yl=e&&e.S()}function Hu(e){var t=this,n=e.data,r=om(n);r.name="ReactiveDom",r.value=n;var o=vl(function(){
for(var c=t,d=t.__v;d=d.__;)if(d.__c){d.__c.__$f|=4;break}var m=mt(function(){var v=r.value.value;return v===0?0:v===!0?
"":v||""}),g=mt(function(){return!Array.isArray(m.value)&&!Yi(m.value)}),_=Le(function(){if(this.N=Uu,g.value){var v=m.value;
c.__v&&c.__v.__e&&c.__v.__e.nodeType===3&&(c.__v.__e.data=v)}}),x=t.__$u.d;return t.__$u.d=function(){_(),x.call(this)},
[g,m]},[]),l=o[0],a=o[1];return l.value?a.peek():a.value}Hu.displayName="ReactiveTextNode";Object.defineProperties(ze.prototype,
{constructor:{configurable:!0,value:mu(te,null).constructor},type:{configurable:!0,value:Hu},props:{configurable:!0,get:function(){
var e=this;return{data:{get value(){return e.value}}}}},__b:{configurable:!0,value:1}});Ir("__b",function(e,t){if(ko(),Sl=
void 0,typeof t.type=="string"){var n,r=t.props;for(var o in r)if(o!=="children"){var l=r[o];l instanceof ze&&(n||(t.__np=
n={}),n[o]=l,r[o]=l.peek())}}e(t)});Ir("__r",function(e,t){if(e(t),t.type!==te){ko();var n,r=t.__c;r&&(r.__$f&=-2,(n=r.__$u)===
void 0&&(r.__$u=n=(function(o,l){var a;return Le(function(){a=this},{name:l}),a.c=o,a})((function(o){return function(){var l;
nm&&((l=this.y)==null||l.call(this)),o.__$f|=1,o.setState({})}})(r),typeof t.type=="function"?t.type.displayName||t.type.
name:""))),Sl=r,ko(n)}});Ir("__e",function(e,t,n,r){ko(),Sl=void 0,e(t,n,r)});Ir("diffed",function(e,t){ko(),Sl=void 0;var n;
if(typeof t.type=="string"&&(n=t.__e)){var r=t.__np,o=t.props,l=n.U;if(l)for(var a in l){var c=l[a];c===void 0||r&&a in r||
(c.d(),l[a]=void 0)}if(r){l||(l={},n.U=l);for(var d in r){var m=l[d],g=r[d];m===void 0?(m=rm(n,d,g,o),l[d]=m):m.o(g,o)}}}
e(t)});function rm(e,t,n,r){var o=t in e&&e.ownerSVGElement===void 0,l=I(n);return{o:function(a,c){l.value=a,r=c},d:Le(function(){
this.N=Uu;var a=l.value.value;r[t]!==a&&(r[t]=a,o?e[t]=a:a!=null&&(a!==!1||t[4]==="-")?e.setAttribute(t,a):e.removeAttribute(
t))})}}Ir("unmount",function(e,t){if(typeof t.type=="string"){var n=t.__e;if(n){var r=n.U;if(r){n.U=void 0;for(var o in r){
var l=r[o];l&&l.d()}}}var a=t.__np;if(a){var c=t.props;for(var d in a)c[d]=a[d]}t.__np=void 0}else{var m=t.__c;if(m){m.__$f|=
8;var g=m.__$u;g&&(m.__$u=void 0,g.d())}}e(t)});Ir("__h",function(e,t,n,r){r<3&&(t.__$f|=2),e(t,n,r)});Dr.prototype.shouldComponentUpdate=
function(e,t){if(this.__R)return!0;var n=this.__$u,r=n&&n.s!==void 0;for(var o in t)return!0;if(this.__f||typeof this.u==
"boolean"&&this.u===!0){var l=2&this.__$f;if(!(r||l||4&this.__$f)||1&this.__$f)return!0}else if(!(r||4&this.__$f)||3&this.
__$f)return!0;for(var a in e)if(a!=="__source"&&e[a]!==this.props[a])return!0;for(var c in this.props)if(!(c in e))return!0;
return!1};function om(e,t){return vl(function(){return I(e,t)},[])}var lm=function(e){queueMicrotask(function(){queueMicrotask(e)})};function im(){un(function(){for(var e;e=zu.shift();)Vu.call(e)})}function Uu(){zu.push(this)===1&&(oe.requestAnimationFrame||
lm)(im)}var sm=95,as=new Set,us=!1,Wu=0;function Gu(e){if(e-Wu<sm){requestAnimationFrame(Gu);return}us=!1,Wu=e;let t=[...as];as.
clear(),un(()=>t.forEach(n=>{n.value+=1}))}function kt(e){as.add(e),!us&&(us=!0,requestAnimationFrame(Gu))}var Bu={int8:1,uint8:1,int16:2,uint16:2,int32:4,uint32:4,int64:8,uint64:8,float32:4,float64:8,string:4},ju=e=>Bu[e],am=/^# MAVLink (\S+) \((\d+)\)/,
um=/^(\w+) (\w+)=(-?\d+)$/,cm=/^(\w+?)(?:\[(\d+)\])? (\w+)(?:\s*#(?: \[(.*?)\])?(?: invalid: (\S+))?)?$/;function fm(e){
let t=e.filter(n=>n!==0);return t.length>1&&Math.max(...t)>2&&t.every(n=>Number.isInteger(Math.log2(n)))}function pm(e,t,n){
let r=`${t.toUpperCase()}_`,o=e.slice(r.length);return e.startsWith(r)&&n.has(o)?o:e}function dm(e,t,n){if(t.length===0)
return null;let r=new Map(t.map(([o,l])=>[l,pm(o,e,n)]));for(let[o]of t)n.add(o);return r}function mm(e,t,n){let[,r="",o,
l="",a="",c=""]=e;if(!(r in Bu))throw new Error(`the schema has a type that MAVLink does not have: ${r}`);let d=dm(l,t,n);
return{name:l,type:r,length:o===void 0?null:Number(o),unit:a,invalid:c,entries:d,isFlags:d!==null&&fm([...d.keys()])}}function qu(e){
let t=e.split(`
`).map(a=>a.trim()).filter(a=>a!==""),n=t[0]?.match(am),r=[],o=new Set,l=[];for(let a of t){let c=a.match(um);c&&l.push(
[c[2]??"",Number(c[3])]);let d=c||a.startsWith("#")?null:a.match(cm);d&&(r.push(mm(d,l,o)),l=[])}return{name:n?.[1]??"",
id:n?Number(n[2]):null,fields:r,indexOf:new Map(r.map((a,c)=>[a.name,c]))}}var hm="mavlink/msg/",Yu=500,gm=1e4,vm=1e4,_m=8e3,ht=I(!1),zr=I(null),To=I(null),Ao=I(""),No=I(""),qt=I(0),at=new Map,cs=new Map,
Eo=new Map,Vr=new Map,Ku=new Set,Qn=null,Mo=Yu,kl=0,Ml=0;function bm(e){if(!e.schemaName.startsWith(hm))return null;let t=cs.
get(e.schemaName);if(t)return t;let n=qu(e.schema);return cs.set(e.schemaName,n),n}function Zu(e){Qn?.readyState===WebSocket.
OPEN&&Qn.send(JSON.stringify(e))}function Ju(e){let t=e.flatMap(n=>at.get(n)?.id??[]);t.length>0&&Zu({op:"subscribe",subscriptions:t.
map(n=>({id:n,channelId:n}))})}function xm(e){let t=at.get(e);t&&Zu({op:"unsubscribe",subscriptionIds:[t.id]})}function wm(e){
for(let t of e)at.set(t.topic,{id:t.id,topic:t.topic,encoding:t.encoding,schema:bm(t)}),Eo.set(t.id,t.topic);Ju(e.map(t=>t.
topic).filter(t=>Vr.has(t))),kt(qt)}function ym(e){for(let t of e){let n=Eo.get(t);n!==void 0&&at.get(n)?.id===t&&at.delete(
n),Eo.delete(t)}kt(qt)}function Sm(e){let t=JSON.parse(e);t.op==="advertise"?wm(t.channels??[]):t.op==="unadvertise"?ym(
t.channelIds??[]):t.op==="serverInfo"?Ao.value=t.name??"":t.op==="status"&&t.id==="drops"?No.value=t.message??"":t.op===
"status"&&console.warn(t.message)}function km(e){let t=new DataView(e);if(t.byteLength<13||t.getUint8(0)!==1)return;let n=Vr.
get(Eo.get(t.getUint32(1,!0))??""),r=Number(t.getBigUint64(5,!0)/1000n),o=new DataView(e,13);n?.forEach(l=>l(o,r))}function Mm(){
Ml=performance.now(),Mo=Yu,un(()=>{ht.value=!0,zr.value=To.value=null});for(let e of Ku)e()}function Xu(){clearTimeout(kl),
Qn=null,at.clear(),Eo.clear(),cs.clear(),un(()=>{(ht.value||To.value===null)&&(To.value=Date.now()),ht.value=!1,zr.value=
Date.now()+Mo,No.value=""}),kl=window.setTimeout(Po,Mo),Mo=Math.min(gm,Mo*1.6)}function Qu(){document.addEventListener("\
visibilitychange",()=>{Ml=performance.now()}),setInterval(()=>{if(!ht.value||document.hidden||performance.now()-Ml<vm)return;
let e=Qn;Xu(),e?.close()},1e3)}function Po(){if(clearTimeout(kl),Qn)return;zr.value=null;let e=new WebSocket(`${location.
protocol==="https:"?"wss":"ws"}://${location.host}/`,["foxglove.sdk.v1","foxglove.websocket.v1"]);e.binaryType="arraybuf\
fer",e.onopen=Mm,e.onclose=()=>{Qn===e&&Xu()},e.onmessage=({data:t})=>{Ml=performance.now(),typeof t=="string"?Sm(t):km(
t)},Qn=e,kl=window.setTimeout(()=>{e.readyState===WebSocket.CONNECTING&&e.close()},_m)}function Hr(e,t){let n=Vr.get(e)??
new Set;return n.add(t),Vr.set(e,n),n.size===1&&Ju([e]),()=>{n.delete(t),!(n.size>0||Vr.get(e)!==n)&&(Vr.delete(e),xm(e))}}
function ec(e){Ku.add(e),ht.value&&e()}var Tl=I(!document.hidden);document.addEventListener("visibilitychange",()=>{Tl.value=!document.hidden});var Tm=new TextDecoder,
er=class{constructor(t,n){this.take=n;ec(()=>{this.loads.value+=1}),Le(()=>{if(!(this.wanted.value===0||!Tl.value||this.
loads.value===0))return this.isNew=!0,Hr(`/mavloom/${t}`,r=>this.apply(Tm.decode(r)))})}take;version=I(0);wanted=I(0);loads=I(
0);isNew=!0;use(){return this.wanted.value+=1,()=>{this.wanted.value-=1}}apply(t){this.take(JSON.parse(t),this.isNew),this.
isNew=!1,kt(this.version)}},fs=0,tc=0;function Oo(e){fs=e,tc=performance.now()}function tr(){return fs===0?Date.now()/1e3:
fs/1e6+(ht.peek()?(performance.now()-tc)/1e3:0)}var gt=I(0);setInterval(()=>{document.hidden||(gt.value+=1)},1e3);var El=I([]),Al=I([]),Ur=I([]),ps=I(0),vt=new Map,Nl=new er("vehicles",e=>{Oo(e.time_us),El.value=e.vehicles}),nr=new er(
"alarms",e=>{Oo(e.time_us),Ur.value=e.alarms,ps.value=e.left_out}),Fn=e=>`${e.sys}/${e.comp}`;function ds(e){return Ur.value.
filter(t=>t.ended_us===null&&t.sys===e.sys&&(t.comp===null||t.comp===e.comp))}var ms=e=>e.autopilot!==null&&e.autopilot!==
"MAV_AUTOPILOT_INVALID"&&e.type!=="MAV_TYPE_GCS",nc=120,Fo=new Map,Pl=e=>[e,...e.links].reduce((t,n)=>t+n.losses.reduce(
(r,o)=>r+o.count,0),0);function Em(e){let t=Fo.get(e.name)??{rates:[],lost:[]};Fo.set(e.name,t),t.rates.push(Math.max(e.
hz_in??0,e.hz_out??0)),t.lost.push({at:performance.now()/1e3,total:Pl(e)}),t.rates.length>nc&&t.rates.shift(),t.lost.length>
nc&&t.lost.shift()}function hs(e){let t=performance.now()/1e3,n=Fo.get(e.name)?.lost.find(r=>r.at>=t-10);return n?{count:Math.
max(0,Pl(e)-n.total),seconds:Math.round(t-n.at)}:{count:0,seconds:0}}var vn=new er("links",e=>{Oo(e.time_us),Al.value=e.
hops,e.hops.forEach(Em)}),rc=()=>Al.value.flatMap(e=>e.hint??[]),oc=0,Am=4e5,Nm=2e4,Pm=60;function Om(e,t){let n=`${e.link??
""} ${e.topic}`,r=vt.get(n)?.newAt??(t<oc+Am?0:t/1e6);vt.set(n,{...e,key:n,seenAt:t/1e6-(e.age_s??0),newAt:r})}function Fm(){
if(!(vt.size<=Nm))for(let e of vt.values())Wr(e)>Pm&&vt.delete(e.key)}var Ol=new er("traffic",(e,t)=>{Oo(e.time_us),t&&(vt.
clear(),oc=e.time_us);for(let n of e.rows)Om(n,e.time_us);Fm()}),Wr=e=>Math.max(0,tr()-e.seenAt),Fl=(e,t=Wr(e))=>e.silent_after_s!=
null&&t>e.silent_after_s;function Cl(e,t=Wr(e)){return Fl(e,t)?0:t>1.5&&t*e.hz>3?1/t:e.hz}var Cm=["overview","messages","plots"],rr=["link","source","name","id","hz","count","bytes","share","gaps","jitter","age"],
Dm=["source","name","hz","count","share","jitter","age"],gs=[10,30,60,300,900],$l=8,vs=8;function ic(){return{view:"over\
view",query:"",sort:{column:"source",isDown:!1},columns:[...Dm],opened:null,plots:[],span:60}}var Dl=e=>encodeURIComponent(
e).replace(/[~!']/g,t=>`%${t.charCodeAt(0).toString(16).toUpperCase()}`).replaceAll("%2F","/").replaceAll("%2C",",");function Ll(e){
try{return decodeURIComponent(e)}catch{return""}}function Lm(e){let t=[Dl(e.topic),Dl(e.formula),String(e.axis),String(e.
scale),String(e.offset)],n=["","","0","1","0"];for(;t.length>2&&t.at(-1)===n[t.length-1];)t.pop();return t.join("~")}var lc=(e,t)=>e!==
void 0&&e!==""&&Number.isFinite(Number(e))?Number(e):t;function $m(e){let[t="",n="",r,o,l]=e.split("~"),a=Ll(t),c=Ll(n);
return a===""||c===""?[]:[{topic:a,formula:c,axis:r==="1"?1:0,scale:lc(o,1),offset:lc(l,0)}]}function Rl(e){let t=ic(),n=[],
r=(o,l,a)=>{l!==a&&n.push(`${o}=${l}`)};r("q",Dl(e.query),""),r("sort",`${e.sort.isDown?"-":""}${e.sort.column}`,t.sort.
column),r("cols",e.columns.join(","),t.columns.join(",")),r("open",Dl(e.opened??""),""),r("span",String(e.span),String(t.
span));for(let o of e.plots)n.push(`plot=${o.map(Lm).join("!")}`);return e.view+(n.length>0?`?${n.join("&")}`:"")}function Rm(e,t){
t.length>0&&e.plots.push(t)}function Im(e,t,n){if(t==="q"&&(e.query=Ll(n)),t==="open"&&(e.opened=Ll(n)||null),t==="span"&&
gs.includes(Number(n))&&(e.span=Number(n)),t==="cols"&&(e.columns=rr.filter(o=>o==="name"||n.split(",").includes(o))),t===
"plot"&&e.plots.length<$l&&Rm(e,n.split("!").flatMap($m).slice(0,vs)),t!=="sort")return;let r=n.replace(/^-/,"");rr.includes(
r)&&(e.sort={column:r,isDown:n.startsWith("-")})}function _s(e){let t=ic(),[n="",r=""]=e.replace(/^#/,"").split("?",2);Cm.
includes(n)&&(t.view=n);for(let o of r.split("&")){let l=o.indexOf("=");l>0&&Im(t,o.slice(0,l),o.slice(l+1))}return t}var or=_s(location.hash),He=I(or.view),Cn=I(or.query),_n=I(or.sort),Dn=I(or.columns),ye=I(or.opened),he=I(or.plots),Ln=I(
or.span),Mt=I(!1),Co=I(""),sc=0;function Gr(e){Co.value=e,clearTimeout(sc),sc=window.setTimeout(()=>{Co.value=""},4e3)}function bs(){
return{view:He.value,query:Cn.value,sort:_n.value,columns:Dn.value,opened:ye.value,plots:he.value,span:Ln.value}}function Vm(e){
un(()=>{He.value=e.view,Cn.value=e.query,_n.value=e.sort,Dn.value=e.columns,ye.value=e.opened,he.value=e.plots,Ln.value=
e.span})}function ac(){let e=`${He.value} ${ye.value}`;Le(()=>{let n=`#${Rl(bs())}`,r=`${He.value} ${ye.value}`;n!==location.
hash&&history[r===e?"replaceState":"pushState"](null,"",n),e=r});let t=()=>{let n=_s(location.hash);e=`${n.view} ${n.opened}`,
Vm(n)};addEventListener("popstate",t)}function Br(e,t){return{topic:e,formula:t,axis:0,scale:1,offset:0}}function Do(e,t=he.
value.length>0?he.value.length-1:null){let n=t===null?void 0:he.value[t];if(n?.some(o=>o.topic===e.topic&&o.formula===e.
formula))return Gr(`${e.formula} is in plot ${(t??0)+1} already`);if(n&&n.length<vs)return he.value=he.value.map((o,l)=>l===
t?[...o,e]:o),Gr(`${e.formula} added to plot ${(t??0)+1}`);if(he.value.length===$l)return Gr(`there are ${$l} plots alre\
ady: remove one first`);he.value=[...he.value,[e]],Gr(`${e.formula} added to plot ${he.value.length}`)}var zm=new Intl.NumberFormat("en-US"),Hm=new Intl.NumberFormat("en-US",{minimumFractionDigits:1,maximumFractionDigits:1}),
ut=e=>e==null?"\u2013":zm.format(e);function $e(e,t){return e==null||!Number.isFinite(e)?"\u2013":e.toFixed(t).replace(/^-(?=[0.]*$)/,
"")}function Tt(e){return e==null?"\u2013":e>=1e3?Hm.format(e):e>0&&e<.05?"<0.1":e.toFixed(1)}function Lo(e){if(e==null)
return"\u2013";let t=["B","kB","MB","GB","TB"],n=0;for(;e>=1e3&&n<t.length-1;)e/=1e3,++n;return`${n===0?e:e.toFixed(e<100?
1:0)} ${t[n]}`}function Yt(e){return e==null||!Number.isFinite(e)?"\u2013":e<1?"<1 s":e<120?`${Math.floor(e)} s`:e<7200?
`${Math.floor(e/60)} min`:e<172800?`${Math.floor(e/3600)} h`:`${Math.floor(e/86400)} d`}var Um=e=>String(e).padStart(2,"\
0");function Il(e){let t=new Date(e/1e3);return[t.getHours(),t.getMinutes(),t.getSeconds()].map(Um).join(":")}function $o(e,t){
if(typeof e=="string")return e;if(!t||typeof e=="bigint")return e.toString();if(!Number.isFinite(e))return Number.isNaN(
e)?"NaN":e>0?"\u221E":"\u2212\u221E";let n=Math.abs(e);return e!==0&&(n>=1e7||n<1e-6)?e.toExponential(4):e.toFixed(n>=1e3?
2:n>=100?3:n>=10?4:5)}function jr(e){let t=Math.abs(e);return Number.isFinite(e)?e!==0&&(t>=1e7||t<1e-4)?e.toExponential(
2):e.toFixed(t>=1e3?1:t>=100?2:t>=1?3:4):"\u2013"}var Wm={px4:"PX4",ardupilotmega:"ArduPilot",gcs:"Ground station",adsb:"\
ADS-B",vtol:"VTOL",generic:"Generic autopilot"};function Ro(e,t){if(e==null)return"\u2013";let n=e.replace(new RegExp(`^${t}`),
"").replaceAll("_"," ").toLowerCase();return Wm[n]??n.charAt(0).toUpperCase()+n.slice(1)}var Gm=Symbol.for("pv"),Bm=0;function i(e,t,n,r,o,l){t||(t={});var a,c,d=t;if("ref"in d&&typeof e!="function")for(c in d={},t)c=="ref"?a=t[c]:d[c]=t[c];
var m={type:e,props:d,key:n,ref:a,__k:null,__:null,__b:0,__e:null,__c:null,constructor:Gm,__v:--Bm,__i:-1,__u:0};return(o||
l)&&(m.__source=o,m.__self=l),oe.vnode&&oe.vnode(m),m}var jm={error:"M8 1.5 15 14H1Z",warning:"M8 1 15 8 8 15 1 8Z",info:"M8 1.5a6.5 6.5 0 1 0 .01 0Z",live:"M8 3.5a4.5 4.5 0 \
1 0 .01 0Z",lost:"M3 3 13 13M13 3 3 13",connecting:"M8 2a6 6 0 1 1-6 6",down:"M3 3 13 13M13 3 3 13",up:"M8 3.5a4.5 4.5 0\
 1 0 .01 0Z",ended:"M3 8.5 6.5 12 13 4.5",auto:"M8 2a6 6 0 1 0 .01 0M8 2v12a6 6 0 0 0 0-12",light:"M8 5a3 3 0 1 0 .01 0M\
8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1",dark:"M13.5 9.5A6 6 0 1 1 6.5 2.5 5 5 0 0 0 1\
3.5 9.5Z",help:"M5.5 5.5a2.5 2.5 0 1 1 3.5 2.3c-.7.4-1 .8-1 1.7M8 12.5v.3",close:"M4 4 12 12M12 4 4 12",plot:"M2 2v12h12\
M4.5 10.5 7.5 6.5 10 9 13.5 4",pause:"M5.5 3v10M10.5 3v10",play:"M5 3 13 8 5 13Z",arrow:"M1 8h13M10 4l4 4-4 4"},qm=["err\
or","warning","info","live","up","play"];function ue({name:e}){return i("svg",{class:`icon ${qm.includes(e)?"filled":""}`,
viewBox:"0 0 16 16","aria-hidden":"true",children:i("path",{d:jm[e]})})}var Vl=["auto","light","dark"],uc="mavloom-colours";function Ym(){let e=localStorage.getItem(uc);return Vl.includes(e)?e:
"auto"}var $n=I(Ym()),xs=I(0);function ws(){document.documentElement.dataset.theme=$n.value,xs.value+=1}function zl(){$n.
value=Vl[(Vl.indexOf($n.value)+1)%Vl.length],localStorage.setItem(uc,$n.value),ws()}matchMedia("(prefers-color-scheme: l\
ight)").addEventListener("change",ws);ws();var qr=8;function lr(e){let t=document.createElement("i");t.style.color=`var(\
--${e})`,document.body.append(t);let n=getComputedStyle(t).color;return t.remove(),n}var nt=class extends Error{constructor(n,r){super(n);this.at=r}at},cc={pi:Math.PI,e:Math.E},fc=180/Math.PI,et=e=>({least:1,
most:1,call:e}),pc=e=>({least:2,most:2,call:e}),ys=e=>({least:1,most:1/0,call:e}),Ts={abs:et(Math.abs),acos:et(Math.acos),
asin:et(Math.asin),atan:et(Math.atan),atan2:pc(Math.atan2),ceil:et(Math.ceil),cos:et(Math.cos),deg:et(e=>e*fc),exp:et(Math.
exp),floor:et(Math.floor),hypot:ys(Math.hypot),log:et(Math.log),log10:et(Math.log10),max:ys(Math.max),min:ys(Math.min),mod:pc(
(e,t)=>e-t*Math.floor(e/t)),rad:et(e=>e/fc),round:et(Math.round),sign:et(Math.sign),sin:et(Math.sin),sqrt:et(Math.sqrt),
tan:et(Math.tan)},As=Object.keys(Ts),Ss=/\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)|([A-Za-z_]\w*)|([-+*/%^()[\],]))/y,
ks=/\s*(\/\d+\/\d+\/[A-Za-z_]\w*(?:\/\w+)?)\./y,Ms=500,dc=50,Km=e=>e===void 0||e.kind==="sign"&&e.text!==")"&&e.text!=="\
]";function Zm(e){let t=[],n=0;for(;e.slice(n).trim()!=="";){let r=n+(e.slice(n).length-e.slice(n).trimStart().length);ks.
lastIndex=Ss.lastIndex=n;let o=Km(t.at(-1))?ks.exec(e):null,l=o??Ss.exec(e);if(!l)throw new nt(`'${[...e.slice(r)][0]}' \
does not belong in a formula`,r);let[,a,c,d]=l,m=o?"topic":a?"number":c?"name":"sign";t.push({kind:m,text:a??c??d??"",at:r}),
n=o?ks.lastIndex:Ss.lastIndex}return t.push({kind:"end",text:"",at:e.length}),t}var Jm={"+":(e,t)=>e+t,"-":(e,t)=>e-t},Xm={
"*":(e,t)=>e*t,"/":(e,t)=>e/t,"%":(e,t)=>e%t},Es=class{constructor(t){this.all=t}all;uses=[];next=0;depth=0;whole(){let t=this.
sum();return this.token.kind!=="end"&&this.fail(`expected an operator before '${this.token.text}'`),t}get token(){return this.
all[this.next]}fail(t,n=this.token.at){throw new nt(t,n)}accept(t){return this.token.kind!=="sign"||this.token.text!==t?
!1:(++this.next,!0)}expect(t,n){this.accept(t)||this.fail(`expected '${t}' ${n}`)}chain(t,n){let r=n();for(let o=this.operator(
t);o;o=this.operator(t)){let l=r,a=n(),c=o;r=d=>c(l(d),a(d))}return r}operator(t){let{kind:n,text:r}=this.token;return n!==
"sign"||!Object.hasOwn(t,r)?null:(++this.next,t[r])}sum(){++this.depth>dc&&this.fail("too many parentheses");let t=this.
chain(Jm,()=>this.chain(Xm,()=>this.signed()));return--this.depth,t}signed(){let t=!1;for(;;)if(this.accept("-"))t=!t;else if(!this.
accept("+"))break;let n=this.power();return t?r=>-n(r):n}power(){let t=this.primary();if(!this.accept("^"))return t;++this.
depth>dc&&this.fail("too many powers");let n=this.signed();return--this.depth,r=>t(r)**n(r)}primary(){let{kind:t,text:n,
at:r}=this.token;if(this.accept("(")){let o=this.sum();return this.expect(")","for the '(' before"),o}if(t==="end"&&this.
fail("the formula ends too early: a number or a field is missing"),t==="sign"&&this.fail(`expected a number or a field b\
efore '${n}'`),++this.next,t==="number"){let o=Number(n);return()=>o}return t==="topic"?this.fieldOf(n):this.accept("(")?
this.call(n,r):this.named(n,r)}fieldOf(t){let{kind:n,text:r,at:o}=this.token;return n!=="name"&&this.fail(`expected a fi\
eld of ${t}`),++this.next,this.field(t,r,o)}named(t,n){let r=Object.hasOwn(cc,t)?cc[t]:void 0,o=this.token.kind==="sign"&&
this.token.text==="[";return r!==void 0&&!o?()=>r:this.field(null,t,n)}field(t,n,r){let o=this.accept("[")?this.element():
null;return this.uses.push({topic:t,name:n,element:o,at:r}),l=>l(n,o,t)}element(){let{kind:t,text:n}=this.token;return(t!==
"number"||!/^\d+$/.test(n))&&this.fail("expected the number of an array element, as in [0]"),++this.next,this.expect("]",
"after the number of the element"),Number(n)}call(t,n){let r=Object.hasOwn(Ts,t)?Ts[t]:void 0;r||this.fail(`there is no \
function '${t}'; there are ${As.join(", ")}`,n);let o=this.arguments();if(o.length<r.least||o.length>r.most){let l=r.most===
1/0?"at least one value":r.least===1?"one value":`${r.least} values`;this.fail(`${t} takes ${l}, not ${o.length}`,n)}return l=>r.
call(...o.map(a=>a(l)))}arguments(){if(this.accept(")"))return[];let t=[this.sum()];for(;this.accept(",");)t.push(this.sum());
return this.expect(")","after the values of the function"),t}};function Io(e){if(e.length>Ms)throw new nt(`a formula has\
 at most ${Ms} characters`,Ms);let t=new Es(Zm(e));return{formula:t.whole(),uses:t.uses}}var hc="mavloom-keys",Yr=I(localStorage.getItem(hc)!=="off");function gc(){Yr.value=!Yr.value,localStorage.setItem(hc,Yr.
value?"on":"off")}var Hl=new Map;function Ul(e){for(let[t,n]of Object.entries(e))Hl.set(t,n);return()=>{for(let[t,n]of Object.
entries(e))Hl.get(t)===n&&Hl.delete(t)}}var mc="";function Rn(e,t=30){mc=e,requestAnimationFrame(()=>{if(mc!==e)return;let n=document.
querySelector(e);n?n.focus({preventScroll:!0}):t>0&&Rn(e,t-1)})}function Ns(){let e=ye.value,t=document.activeElement?.closest(
"aside.message")!=null;if(ye.value=null,!t||e===null)return;(document.querySelector(`[data-row$="${CSS.escape(` ${e}`)}"\
]`)??document.querySelector("main .scroller"))?.focus()}var Qm={1:()=>{He.value="overview"},2:()=>{He.value="messages"},
3:()=>{He.value="plots"},"?":()=>{Mt.value=!Mt.value},t:zl,"/":()=>{He.value="messages",Rn("#search")}};function vc(e){return e instanceof
HTMLElement?e instanceof HTMLInputElement&&e.type!=="checkbox"||e instanceof HTMLTextAreaElement||e instanceof HTMLSelectElement:
!1}function eh(){let e=document.querySelector("details[open]");return e&&(e.open=!1),e?.querySelector("summary")?.focus(),
e!==null}function th(e){if(Mt.value)Mt.value=!1;else{if(eh())return;vc(e)?e.blur():Ns()}}function _c(e){if(e.ctrlKey||e.
metaKey||e.altKey||e.defaultPrevented)return;if(e.key==="Escape")return e.preventDefault(),th(e.target);if(vc(e.target)||
!Yr.value&&e.key.length===1||e.key===" "&&e.target instanceof HTMLButtonElement)return;let t=Hl.get(e.key)??Qm[e.key];!t||
Mt.value&&e.key!=="?"||(e.preventDefault(),t(e))}var nh=[["Everywhere",[["1 2 3","Overview, Messages, Plots"],["/","search messages"],["t","light, dark, as the system"],
["Esc","close, leave a field"],["?","this list"]]],["Messages",[["j k, \u2193 \u2191","next, previous row"],["Enter","op\
en the row"],["f","freeze the table"],["c","compare with the frozen state"],["Tab","to the open message: its close butto\
n, then its fields; Enter plots one"]]],["Plots",[["Space","stop, follow again"],["+ \u2212","zoom"],["\u2190 \u2192","e\
arlier, later"],["0","follow the latest"],["a","add a formula"]]]];function rh({title:e,keys:t}){return i("section",{children:[
i("h3",{children:e}),i("dl",{class:"keys",children:t.map(([n,r])=>[i("dt",{children:i("kbd",{children:n})},n),i("dd",{children:r},
r)])})]})}var oh=()=>i("p",{children:["Formulas have fields, array elements such as ",i("code",{children:"voltages[0]"}),
", ",i("code",{children:"+ - * / % ^ ( )"}),","," ",i("code",{children:"pi"}),", ",i("code",{children:"e"})," and"," ",As.
map((e,t)=>[t>0?", ":"",i("code",{children:e},e)]),". A field of another topic has its name before it, as in ",i("code",
{children:"alt - /2/1/VFR_HUD.alt"}),": the latest value counts."]});function bc(){Mt.value=!1}function xc(){let e=$t(null);
return Qe(()=>{Mt.value&&!e.current?.open&&e.current?.showModal(),!Mt.value&&e.current?.open&&e.current?.close()},[Mt.value]),
i("dialog",{ref:e,"aria-labelledby":"help-title",onClose:bc,children:[i("header",{children:[i("h2",{id:"help-title",children:"\
Keys"}),i("button",{class:"quiet",onClick:bc,"aria-label":"Close",children:i(ue,{name:"close"})})]}),i("div",{class:"gro\
ups",children:nh.map(([t,n])=>i(rh,{title:t,keys:n},t))}),i("label",{class:"check",children:[i("input",{type:"checkbox",
checked:Yr.value,onChange:gc})," Keys of one letter work"]}),i(oh,{}),i("p",{class:"dim",children:[Ao.value," \xB7 ",i("\
a",{href:"licences.txt",children:"Licences of what this page contains"})]})]})}var Wl=4,lh=new TextDecoder;function wc(e){return e<=Number.MAX_SAFE_INTEGER&&e>=Number.MIN_SAFE_INTEGER?Number(e):e}var ih={
int8:(e,t)=>e.getInt8(t),uint8:(e,t)=>e.getUint8(t),int16:(e,t)=>e.getInt16(t,!0),uint16:(e,t)=>e.getUint16(t,!0),int32:(e,t)=>e.
getInt32(t,!0),uint32:(e,t)=>e.getUint32(t,!0),int64:(e,t)=>wc(e.getBigInt64(t,!0)),uint64:(e,t)=>wc(e.getBigUint64(t,!0)),
float32:(e,t)=>e.getFloat32(t,!0),float64:(e,t)=>e.getFloat64(t,!0)},Ps=class{constructor(t){this.data=t}data;at=Wl;field(t){
if(t.length===null)return this.scalar(t.type);let n=new Array(t.length);for(let r=0;r<t.length;++r)n[r]=this.scalar(t.type);
return n}scalar(t){let n=ju(t);if(this.at=Wl+Math.ceil((this.at-Wl)/n)*n,t==="string")return this.text();let r=ih[t](this.
data,this.at);return this.at+=n,r}text(){let t=this.data.getUint32(this.at,!0),n=new Uint8Array(this.data.buffer,this.data.
byteOffset+this.at+4,Math.max(0,t-1));return this.at+=4+t,lh.decode(n)}};function Gl(e,t){if(t.byteLength<Wl||t.getUint8(
1)!==1)throw new RangeError("not a little-endian CDR message");let n=new Ps(t);return e.fields.map(r=>n.field(r))}function yc(e,t,n){
let r=e[t],o=Array.isArray(r)?r[n??0]:r;return typeof o=="string"||o===void 0?NaN:Number(o)}var Bl=I(0),Os=null;function jl(){Bl.value,qt.value;let e=ye.value;if(e===null)return null;let t=Os?.topic===e?Os:null,n=t?.
schema??at.get(e)?.schema;if(!n)return null;let r={topic:e,schema:n,message:null,timeUs:t?.timeUs??0,error:""};if(!t)return r;
try{return{...r,message:Gl(n,t.data)}}catch(o){return{...r,error:String(o)}}}function Sc(){Le(()=>{let e=ye.value;if(!(e===
null||!Tl.value))return Hr(e,(t,n)=>{let r=at.get(e)?.schema;r&&(Os={topic:e,schema:r,data:t,timeUs:n},kt(Bl))})})}var Ae=I(null),Rt=I(!1);function ql(){Ae.value={at:tr(),opened:jl(),rows:new Map(vt)},Rt.value=!1}function Fs(){Ae.value=
null,Rt.value=!1}function Cs(){Ae.value===null&&ql(),Rt.value=!Rt.value}var Mc=()=>Ae.value&&!Rt.value?Ae.value.rows:vt;
function Ds(e){let t=Ae.value;return t&&!Rt.value?Fl(e,t.at-e.seenAt)?"silent":"":(t?!t.rows.has(e.key):e.newAt>0&&tr()-
e.newAt<10)?"new":Fl(e)?"silent":""}var Ls=e=>Ae.value&&!Rt.value?Math.max(0,Ae.value.at-e.seenAt):Wr(e),zo=e=>Cl(e,Ls(e));
function sh(e){let t=e.toLowerCase().split(/\s+/).filter(o=>o!==""),n=t.filter(o=>/^\d+\/\d*$/.test(o)),r=t.filter(o=>!n.
includes(o));return o=>{let l=`${o.sys}/${o.comp}`;return n.every(c=>c.endsWith("/")?l.startsWith(c):l===c)&&r.every(c=>ah(
o).includes(c))}}var kc=new WeakMap;function ah(e){let t=kc.get(e);if(t!==void 0)return t;let n=`${e.topic} ${e.link??""}\
 ${e.id}`.toLowerCase();return kc.set(e,n),n}var Kr=e=>e===0?0:Number(e.toPrecision(2)),uh={source:e=>e.sys*256+e.comp,id:e=>e.
id,hz:e=>Kr(zo(e)),count:e=>Kr(e.count),bytes:e=>Kr(e.bytes),share:e=>Kr(e.share),gaps:e=>Kr(e.gap_max_ms??-1),jitter:e=>Kr(
e.jitter_ms??-1),age:e=>Math.floor(Wr(e))},ch=(e,t)=>e.sys-t.sys||e.comp-t.comp||Vo(e.name,t.name)||fh(e.instance,t.instance)||
Vo(e.key,t.key),Vo=(e,t)=>e<t?-1:e>t?1:0,fh=(e,t)=>Number(e)-Number(t)||Vo(String(e??""),String(t??""));function ph(e){let t=uh[e];
return t?(n,r)=>t(n)-t(r):e==="link"?(n,r)=>Vo(n.link??"",r.link??""):(n,r)=>Vo(n.name,r.name)}function Tc(e,t,n){let r=ph(
n.column),o=n.isDown?-1:1;return[...e].filter(sh(t)).sort((l,a)=>o*r(l,a)||ch(l,a))}var Ec=6;function dh(e){let t=$t(null),[n,r]=Fu({top:0,height:800,row:26});$r(()=>{let l=t.current;if(!l)return;let a=()=>{
let d=parseFloat(getComputedStyle(l).getPropertyValue("--row"))||26;r({top:l.scrollTop,height:l.clientHeight,row:d})},c=new ResizeObserver(
a);return c.observe(l),l.addEventListener("scroll",a,{passive:!0}),()=>{c.disconnect(),l.removeEventListener("scroll",a)}},
[]);let o=Math.max(0,Math.min(e,Math.floor(n.top/n.row)-Ec));return{scroller:t,row:n.row,first:o,end:Math.min(e,Math.ceil(
(n.top+n.height)/n.row)+Ec)}}function mh({columns:e,sort:t,onSort:n}){let r=t?.isDown?"descending":"ascending";return i(
"thead",{children:i("tr",{"aria-rowindex":1,children:e.map(o=>i("th",{scope:"col",title:o.help,class:`c-${o.key} ${o.isNumber?
"number":""}`,"aria-sort":t?.column===o.key?r:void 0,children:n&&o.label!==""?i("button",{onClick:()=>n(o.key),children:o.
label}):o.label||i("span",{class:"hidden",children:o.help})},o.key))})})}var Ac=({rows:e,row:t})=>e<=0?null:i("tr",{class:"\
spacer","aria-hidden":"true",children:i("td",{style:{height:`${e*t}px`}})});function hh({current:e,rows:t,keyOf:n},r){Qe(
()=>{let o=r.scroller.current,l=t.findIndex(d=>n(d)===e);if(!o||l<0)return;let a=l*r.row,c=o.clientHeight-2*r.row;a<o.scrollTop?
o.scrollTop=a:a>o.scrollTop+c&&(o.scrollTop=a-c)},[e])}function gh({columns:e,row:t}){return i(te,{children:e.map(n=>i("\
td",{class:`c-${n.key} ${n.isNumber?"number":""}`,children:n.cell(t)},n.key))})}function Yl(e){let{caption:t,columns:n,rows:r,
keyOf:o,classOf:l,current:a}=e,c=dh(r.length),{scroller:d,row:m,first:g,end:_}=c,x=v=>`${l?.(v)??""} ${o(v)===a?"current":
""}`;return hh(e,c),i("div",{class:"scroller",ref:d,tabIndex:-1,children:i("table",{"aria-rowcount":r.length+1,children:[
i("caption",{class:"hidden",children:t}),i("colgroup",{children:n.map(v=>i("col",{class:`c-${v.key}`},v.key))}),i(mh,{...e}),
i("tbody",{children:[i(Ac,{rows:g,row:m}),r.slice(g,_).map((v,k)=>i("tr",{"aria-rowindex":g+k+2,class:x(v),children:gh({
columns:n,row:v})},o(v))),i(Ac,{rows:r.length-_,row:m})]})]})})}var vh={degE7:[1e-7,"\xB0",7],cdeg:[.01,"\xB0",2],rad:[180/Math.PI,"\xB0",2],"rad/s":[180/Math.PI,"\xB0/s",2],mm:[.001,"\
m",3],cm:[.01,"m",2],"cm/s":[.01,"m/s",2],"mm/s":[.001,"m/s",3],mV:[.001,"V",3],cV:[.01,"V",2],cA:[.01,"A",2],mA:[.001,"\
A",3],cdegC:[.01,"\xB0C",2],"c%":[.01,"%",2],"d%":[.1,"%",1]},Nc=e=>String(Math.floor(e)).padStart(2,"0"),_h=e=>`${Math.
floor(e/3600)}:${Nc(e/60%60)}:${Nc(e%60)}`;function Pc(e){return e>1e9?new Date(e*1e3).toISOString().slice(0,19).replace(
"T"," "):_h(e)}function Oc(e,t){let n=Number(e);if(!Number.isFinite(n))return"";if(t==="us"&&n>=1e6)return Pc(n/1e6);if(t===
"ms"&&n>=1e4)return Pc(n/1e3);let r=vh[t];if(!r)return"";let[o,l,a]=r;return`${Math.abs(n*o)>=1e6?jr(n*o):$e(n*o,a)}${l.
startsWith("\xB0")&&l!=="\xB0C"&&l!=="\xB0/s"?"":" "}${l}`}function bh(e,t){let[,n,r,o]=e.match(/^(U?)INT(8|16|32|64)_(MAX|MIN)$/)??[];if(r===void 0)return xh(e,t)??(e.toLowerCase()===
"nan"?NaN:Number(e));let l=Number(r)-(n?0:1);return o==="MAX"?2**l-1:n?0:-(2**l)}var xh=(e,t)=>[...t.entries??[]].find(([
,n])=>n===e)?.[0];function $s(e,t,n){if(t===""||e===void 0)return!1;let r=bh(t,n);return Number(e)===r||Number.isNaN(r)&&
Number.isNaN(Number(e))}function Kl(e,t,n){let r=e.invalid;if(r===""||e.type==="string")return!1;let o=Array.isArray(t)?
t:[t],l=o[n??0];if(!r.startsWith("("))return $s(l,r,e);let a=r.slice(1,-1);return a.endsWith(":")?$s(o[0],a.slice(0,-1),
e):$s(l,a.includes(",")?a.split(",")[n??0]??"":a,e)}var Vs="application/x-mavloom-series",Rs=16,Zl=e=>e.type.startsWith("float"),Is=I(new Set);function wh(e){let t=Ae.value?.
opened;return t?.topic===e.topic&&t.schema===e.schema?t.message:null}function yh(e,t){return[...e.entries??[]].filter(([
r])=>r!==0&&Math.floor(t/r)%2===1).map(([,r])=>Cc(r,e))}function Cc(e,t){let n=[...t.entries?.values()??[]];if(n.length<
2)return e;let r=0;for(;n.every(o=>o[r]===n[0]?.[r]&&r<o.length);)++r;return e.slice(n[0]?.lastIndexOf("_",r-1)===-1?0:(n[0]?.
lastIndexOf("_",r-1)??-1)+1)}var Dc=({field:e,whole:t,element:n})=>Kl(e,t,n);function Lc(e){let{field:t,raw:n}=e;if(typeof n==
"string")return"";let r=t.entries?.get(Number(n));return r!==void 0?Cc(r,t):Dc(e)?"unknown":t.isFlags?yh(t,Number(n)).join(
", "):Oc(n,t.unit)}var $c=({name:e})=>i(te,{children:e.split(/(?<=_)/).flatMap((t,n)=>n===0?[t]:[i("wbr",{},n),t])});function Sh({
field:e,raw:t,formula:n}){let r=()=>Do(Br(ye.value??"",n));return i("button",{class:"value mono",title:`Plot ${n}`,"aria\
-label":`Plot ${n}, ${$o(t,Zl(e))}`,onClick:r,children:$o(t,Zl(e))})}var Rc=36,Fc=()=>Ae.value?5:4;function kh({field:e,
raw:t,before:n}){if(!Ae.value)return null;let r=n!==void 0&&!Object.is(n,t);return i("td",{class:`number mono ${r?"chang\
ed":"dim"}`,children:n===void 0?"":$o(n,Zl(e))})}function Mh(e){let{field:t,raw:n,formula:r}=e,o=Lc(e);return i(te,{children:[
i("td",{class:"number",children:i(Sh,{field:t,raw:n,formula:r})}),i(kh,{...e}),i("td",{class:"dim f-unit",children:Dc(e)?
"":t.unit}),i("td",{class:"meaning",children:o.length>Rc?"":o})]})}function Ic(e){let{field:t,raw:n,element:r}=e,o=r===null?
t.name:`${t.name}[${r}]`,l=typeof n=="string",a=l?n:Lc(e);return i(te,{children:[i("tr",{draggable:!l,onDragStart:d=>{d.
dataTransfer?.setData(Vs,JSON.stringify(Br(ye.value??"",o))),d.dataTransfer?.setData("text/plain",o)},class:r===null?"":
"element",children:[i("th",{scope:"row",children:r===null?i($c,{name:t.name}):`[${r}]`}),l?i("td",{class:"text",colSpan:Fc()-
1,children:n}):i(Mh,{...e,formula:o})]}),!l&&a.length>Rc&&i("tr",{class:"more",children:i("td",{colSpan:Fc(),children:a})})]})}
function Th(e){let t=new Set(Is.value);t.delete(e)||t.add(e),Is.value=t}function Eh({field:e,all:t,isOpen:n,name:r}){let o=t.
slice(0,Rs).map(a=>$o(a,Zl(e))),l=`${t.length} elements`;return i("tr",{class:"array",children:[i("th",{scope:"row",children:i(
$c,{name:e.name})}),i("td",{colSpan:Ae.value?2:1,class:"dim",children:t.length<=Rs?l:i("button",{class:"link","aria-expa\
nded":n,onClick:()=>Th(r),children:l})}),i("td",{class:"dim f-unit",children:e.unit}),i("td",{class:"meaning mono cut",children:n?
"":`${o.join(" ")} \u2026`})]})}function Ah({field:e,all:t,before:n}){let r=`${ye.value} ${e.name}`,o=t.length<=Rs||Is.value.
has(r),l=Array.isArray(n)?n:[];return i(te,{children:[i(Eh,{field:e,all:t,isOpen:o,name:r}),o&&t.map((a,c)=>i(Ic,{field:e,
raw:a,whole:t,element:c,before:l[c]},c))]})}function Nh({field:e,raw:t,before:n}){return Array.isArray(t)?i(Ah,{field:e,
all:t,before:n}):i(Ic,{field:e,raw:t,whole:t,before:n,element:null})}var Ph=()=>i("thead",{class:Ae.value?"":"hidden",children:i(
"tr",{children:[i("th",{scope:"col",children:"Field"}),i("th",{scope:"col",class:"number",children:"Value"}),Ae.value&&i(
"th",{scope:"col",class:"number",children:"Then"}),i("th",{scope:"col",class:"f-unit",children:"Unit"}),i("th",{scope:"c\
ol",children:"Meaning"})]})});function Oh({now:e}){let t=wh(e),{schema:n,message:r}=e;return r?i("table",{class:`fields ${Ae.
value?"compared":""}`,children:[i("caption",{class:"hidden",children:["Fields of ",n.name]}),i("colgroup",{children:[i("\
col",{class:"f-name"}),i("col",{class:"f-value"}),Ae.value&&i("col",{class:"f-value"}),i("col",{class:"f-unit"}),i("col",
{})]}),i(Ph,{}),i("tbody",{children:n.fields.map((o,l)=>i(Nh,{field:o,raw:r[l],before:t?.[l]},o.name))})]}):i("p",{class:"\
empty",children:e.error||"No message has come yet."})}var Fh=()=>i("p",{class:"empty",children:qt.value>0&&ht.value?"Not\
hing with this name was heard.":"Waiting for the server."}),Ch=({topic:e})=>i("header",{children:[i("h3",{children:i("sp\
an",{class:"mono cut",title:e,children:e})}),i("button",{class:"quiet end",onClick:Ns,"aria-label":"Close the message",title:"\
Close (Esc)",children:i(ue,{name:"close"})})]});function Jl({hz:e}){Bl.value,gt.value;let t=jl(),n=ye.value??"";return i(
"aside",{class:"message","aria-label":`Message ${n}`,children:[i(Ch,{topic:n}),i("p",{class:"dim number about",children:[
t&&`id ${t.schema.id}`,e!==null&&i("span",{children:[Tt(e)," /s"]}),t&&t.timeUs>0&&i("span",{children:["at ",Il(t.timeUs)]})]}),
i("div",{class:"scroller",tabIndex:-1,children:t?i(Oh,{now:t}):i(Fh,{})}),i("p",{class:"hint dim",children:He.value==="p\
lots"?"Click a number, or drag it into a plot.":"Click a number to plot it."})]})}function Xl({text:e}){let t=rc();return vn.version.value===0?i("p",{class:"empty",children:"The server has not reported \
yet."}):t.length===0?i("p",{class:"empty",children:e}):i("ul",{class:"empty hints",children:t.map(n=>i("li",{children:[n,
"."]},n))})}var Jr=I(null),Kt=mt(()=>(Ol.version.value,Ae.value,Rt.value,_n.value.column==="age"&&gt.value,Tc(Mc().values(),Cn.value,
_n.value))),Dh=mt(()=>{let e=new Map;for(let{topic:t}of Kt.value)e.set(t,(e.get(t)??0)+1);return e});function Lh(e){Jr.value=
e.key,ye.value=ye.value===e.topic?null:e.topic}var $h=e=>e.link?.split("#").at(-1)??"";function Rh({row:e}){let t=e.key===
(Jr.value??Kt.value[0]?.key);return i("button",{class:"name mono","data-row":e.key,tabIndex:t?0:-1,"aria-expanded":ye.value===
e.topic,onClick:()=>Lh(e),onFocus:()=>{Jr.value=e.key},children:[e.name,e.instance!==null&&i("span",{class:"instance",children:[
"/",e.instance]}),(Dh.value.get(e.topic)??0)>1&&i("span",{class:"by dim",children:$h(e)})]})}function Ih(e){let t=Ds(e);
return t===""?null:i("span",{class:`mark ${t}`,children:t})}var Vh=({row:e})=>{let t=Ae.value?.rows.get(e.key);if(!t)return i(
te,{children:"\u2013"});let n=Math.abs(t.hz-Cl(e))>.1*Math.max(t.hz,e.hz,1);return i("span",{class:n?"changed":"dim",children:Tt(
t.hz)})},zh=({row:e})=>{let t=e.count-(Ae.value?.rows.get(e.key)?.count??0);return i("span",{class:t===0?"dim":"",children:t>
0?`+${ut(t)}`:ut(t)})},Hh=e=>e.gap_min_ms==null?"\u2013":`${$e(e.gap_min_ms,0)} \u2013 ${$e(e.gap_max_ms,0)}`,zc={mark:{
key:"mark",label:"",help:"new or silent",cell:Ih},link:{key:"link",label:"Link",cell:e=>i("span",{class:"cut",title:e.link??
"",children:e.link??"\u2013"})},source:{key:"source",label:"From",help:"system/component",cell:e=>i("span",{class:"mono",
children:[e.sys,"/",e.comp]})},name:{key:"name",label:"Message",cell:e=>i(Rh,{row:e})},id:{key:"id",label:"Id",isNumber:!0,
cell:e=>e.id},hz:{key:"hz",label:"Rate /s",isNumber:!0,cell:e=>Tt(zo(e))},before:{key:"before",label:"Then /s",help:"the\
 rate in the frozen state",isNumber:!0,cell:e=>i(Vh,{row:e})},count:{key:"count",label:"Count",isNumber:!0,cell:e=>ut(e.
count)},more:{key:"more",label:"Since",help:"messages since the frozen state",isNumber:!0,cell:e=>i(zh,{row:e})},bytes:{
key:"bytes",label:"Bytes",isNumber:!0,cell:e=>Lo(e.bytes)},share:{key:"share",label:"Share %",help:"of the link's bytes",
isNumber:!0,cell:e=>$e(e.share*100,1)},gaps:{key:"gaps",label:"Gaps ms",help:"shortest and longest time between two mess\
ages",isNumber:!0,cell:Hh},jitter:{key:"jitter",label:"Jitter ms",isNumber:!0,cell:e=>$e(e.jitter_ms,1)},age:{key:"age",
label:"Age",help:"since the latest message",isNumber:!0,cell:e=>Yt(Ls(e))}},Uh={hz:["hz","before"],count:["count","more"],
bytes:[],share:[],gaps:[],jitter:[]};function Wh(){let e=rr.filter(r=>Dn.value.includes(r)),t=e.toSpliced(e.indexOf("nam\
e")+1,0,"mark");return(Rt.value?t.flatMap(r=>Uh[r]??[r]):t).flatMap(r=>zc[r]??[])}function Gh(e){if(!rr.includes(e))return;
let t=["source","name","link","id"].includes(e);_n.value=_n.value.column===e?{column:e,isDown:!_n.value.isDown}:{column:e,
isDown:!t}}function Bh(){let e=n=>{let r=Dn.value.includes(n);Dn.value=rr.filter(o=>o===n?!r:Dn.value.includes(o))},t=$t(
null);return Qe(()=>{let n=r=>{t.current&&!t.current.contains(r.target)&&(t.current.open=!1)};return document.addEventListener(
"pointerdown",n),()=>document.removeEventListener("pointerdown",n)},[]),i("details",{class:"chooser",ref:t,children:[i("\
summary",{children:"Columns"}),i("div",{class:"menu",children:rr.filter(n=>n!=="name").map(n=>i("label",{class:"check",children:[
i("input",{type:"checkbox",checked:Dn.value.includes(n),onChange:()=>e(n)})," ",zc[n]?.label]},n))})]})}function jh(){let e=Ae.
value;return i("span",{class:"group",children:[i("button",{"aria-pressed":e!==null,onClick:()=>e?Fs():ql(),title:"Freeze\
 the table (f)",children:[i(ue,{name:e?"play":"pause"}),e?"Thaw":"Freeze"]}),e&&i("button",{"aria-pressed":Rt.value,onClick:Cs,
title:"Live values beside the frozen ones (c)",children:"Compare"})]})}function qh(){Ol.version.value;let e=Kt.value.reduce(
(n,r)=>n+zo(r),0),t=Ae.value===null?"":Rt.value?" \xB7 live, compared":" \xB7 frozen";return i("span",{class:"summary di\
m number",role:"status","aria-live":"off",children:[ut(Kt.value.length),Kt.value.length<vt.size&&` of ${ut(vt.size)}`," \
rows \xB7"," ",Math.round(e).toLocaleString("en-US")," /s",t]})}function Yh(){return i("div",{class:"toolbar",children:[
i("input",{id:"search",type:"search",placeholder:"Search: 1/1 battery","aria-label":"Search messages",value:Cn.value,autocomplete:"\
off",spellcheck:!1,onInput:e=>{Cn.value=e.currentTarget.value},onKeyDown:e=>{(e.key==="Enter"||e.key==="ArrowDown")&&Ql(
0)}}),i(jh,{}),i(Bh,{}),i(qh,{})]})}function Ql(e){let t=Kt.value[Math.max(0,Math.min(Kt.value.length-1,e))];t&&(Jr.value=
t.key,Rn(`[data-row="${CSS.escape(t.key)}"]`))}var Vc=()=>Kt.value.findIndex(e=>e.key===Jr.value),Zr=e=>()=>Ql(Vc()<0?0:
Vc()+e),Kh={j:Zr(1),ArrowDown:Zr(1),k:Zr(-1),ArrowUp:Zr(-1),PageDown:Zr(20),PageUp:Zr(-20),Home:()=>Ql(0),End:()=>Ql(1/0),
f:()=>Ae.value?Fs():ql(),c:Cs};function Zh(){let e=Kt.value.filter(t=>t.topic===ye.value);return e.length===0?null:e.reduce(
(t,n)=>t+zo(n),0)}function Hc(){return Qe(()=>Ol.use(),[]),Qe(()=>vn.use(),[]),$r(()=>Ul(Kh),[]),gt.value,i(te,{children:[
i("h2",{class:"hidden",children:"Messages"}),i("div",{class:"list",children:[i(Yh,{}),i(Yl,{caption:"Messages, a row for\
 each sender, message and instance",columns:Wh(),rows:Kt.value,keyOf:e=>e.key,current:Jr.value,sort:_n.value,onSort:Gh,classOf:e=>`${Ds(
e)} ${e.topic===ye.value?"open":""}`}),vt.size===0&&i(Xl,{text:"No message has come yet."}),vt.size>0&&Kt.value.length===
0&&i("p",{class:"empty",children:"No message matches the search."})]}),ye.value!==null&&i(Jl,{hz:Zh()})]})}var zs=100;function Uc(e){return[e.sys===null?"":`${e.sys}${e.comp===null?"":`/${e.comp}`}`,e.link??""].filter(n=>n!=="").
join(" ")}function Jh({alarm:e}){let t=e.ended_us!==null,n=(t?(e.ended_us??0)/1e6:tr())-e.since_us/1e6;return i("li",{class:t?
"over":e.severity,children:[i("span",{class:"severity",children:[i(ue,{name:t?"ended":e.severity}),t?"over":e.severity]}),
i("time",{class:"number dim",dateTime:new Date(e.since_us/1e3).toISOString(),children:Il(e.since_us)}),i("span",{class:"\
mono about",children:Uc(e)}),i("span",{class:"text",children:e.text}),i("span",{class:"lasted number dim",children:t?`la\
sted ${Yt(n)}`:`for ${Yt(n)}`})]})}function Xh({alarm:e}){return i("p",{class:"hidden",role:"status","aria-live":"polite",
children:e?`${e.severity}: ${Uc(e)} ${e.text}`:""})}var Qh=({number:e})=>e===0?null:i("li",{class:"note dim",children:[ut(
e)," older ",e===1?"one has":"ones have"," left the list, which was full"]});function Wc(){nr.version.value,gt.value;let e=[
...Ur.value].sort((n,r)=>+(n.ended_us!==null)-+(r.ended_us!==null)||r.since_us-n.since_us),t=e.filter(n=>n.ended_us===null);
return i("section",{"aria-labelledby":"alarms",children:[i("h2",{id:"alarms",children:["Alarms ",i("span",{class:"dim",children:t.
length>0?`${t.length} now`:""})]}),i(Xh,{alarm:t[0]}),e.length===0&&(nr.version.value===0?i("p",{class:"empty",children:"\
The server has not reported yet."}):i("p",{class:"empty",children:[i(ue,{name:"ended"}),"No alarm now, and none in the l\
ast ten minutes."]})),i("ul",{class:"alarms panel",hidden:e.length===0,children:[e.slice(0,zs).map(n=>i(Jh,{alarm:n},n.id)),
e.length>zs&&i("li",{class:"note dim",children:["and ",e.length-zs," more"]}),i(Qh,{number:ps.value})]})]})}var Gc=120,Hs=22;function eg({name:e}){vn.version.value;let t=Fo.get(e)?.rates??[],n=Math.max(1,...t),r=Gc-t.length+1,o=t.
map((l,a)=>`${r+a},${(Hs-1-l/n*(Hs-3)).toFixed(1)}`);return i("svg",{class:"trend",viewBox:`0 0 ${Gc} ${Hs}`,preserveAspectRatio:"\
none",role:"img","aria-label":`frames a second in the last minute, at most ${Math.round(n)}`,children:o.length>1&&i("pol\
yline",{points:o.join(" ")})})}var qc=({loss:e})=>i("li",{title:e.help,children:[i("span",{children:e.name.replaceAll("_",
" ")}),i("b",{class:"number",children:ut(e.count)}),e.help&&i("small",{children:e.help})]});function tg({hop:e}){let{count:t,
seconds:n}=hs(e),r=Pl(e);return r===0?i("p",{class:"fine",children:[i(ue,{name:"ended"}),"nothing lost here"]}):i("div",
{class:`losses ${t>0?"error":""}`,children:[i("p",{children:[i(ue,{name:t>0?"error":"info"}),ut(r)," lost",n>0&&i("span",
{class:"end",children:t>0?`+${ut(t)} in ${n} s`:`none in the last ${n} s`})]}),i("ul",{children:e.losses.map(o=>i(qc,{loss:o},
o.name))})]})}var ng={up:"up",down:"down",ended:"ended"};function rg({link:e}){return i("li",{class:e.state,children:[i(
"span",{class:"link",title:e.name,children:[i(ue,{name:ng[e.state]}),i("span",{class:"mono cut",children:e.name}),e.state!==
"up"&&` ${e.state}`]}),i("span",{class:"number dim",title:`${Lo(e.bytes_in)} in, ${Lo(e.bytes_out)} out`,children:[i("b",
{children:Tt(e.hz_in)})," in ",i("b",{children:Tt(e.hz_out)})," out"]}),e.losses.length>0&&i("ul",{class:"losses",children:e.
losses.map(t=>i(qc,{loss:t},t.name))})]})}var Bc=({name:e,hz:t,frames:n})=>i("div",{children:[i("dt",{children:e}),i("dd",
{children:[i("b",{children:Tt(t)}),i("span",{class:"unit",children:"/s"})]}),i("dd",{class:"dim",children:ut(n)})]}),Yc=e=>e.
kind==="source"&&e.frames_in+e.frames_out===0,Kc=e=>e.state!=="up"&&e.kind!=="station"&&!Yc(e),og=e=>Yc(e)?"waiting":Kc(
e)?"down":"not here";function lg({hop:e}){let t=e.state==="up",n=e.name.endsWith(e.kind)?"":e.kind;return i("header",{children:[
i("h3",{children:[i(ue,{name:t?"up":"down"}),i("span",{class:"cut",title:e.name,children:e.name})]}),i("span",{class:"en\
d dim",children:[i("span",{class:"kind",children:n})," ",t?"":og(e)]})]})}function ig({hop:e}){let t=`panel hop ${Kc(e)?
"down":""} ${hs(e).count>0?"losing":""}`;return i("li",{class:t,children:[i(lg,{hop:e}),i(eg,{name:e.name}),i("dl",{class:"\
rates",children:[i(Bc,{name:"in",hz:e.hz_in,frames:e.frames_in}),i(Bc,{name:"out",hz:e.hz_out,frames:e.frames_out})]}),i(
tg,{hop:e}),e.hint&&i("p",{class:"hint",children:e.hint}),e.links.length>0&&i("ul",{class:"links",children:e.links.map(n=>i(
rg,{link:n},n.name))})]})}var jc=({all:e})=>i("ol",{class:"hops",children:e.map((t,n)=>[n>0&&i("li",{class:"arrow","aria\
-hidden":"true",children:i(ue,{name:"arrow"})},`to ${t.name}`),i(ig,{hop:t},t.name)])});function Zc(){vn.version.value;let e=Al.
value,t=1+e.findIndex(n=>n.kind==="station")||e.length;return i("section",{"aria-labelledby":"hops",children:[i("h2",{id:"\
hops",children:["Hops"," ",i("span",{class:"dim",children:e.length>0&&`${t}, in the order in which frames pass them`})]}),
e.length===0&&i("p",{class:"empty",children:"The server has not reported yet."}),i(jc,{all:e.slice(0,t)}),t<e.length&&i(
te,{children:[i("h3",{class:"aside dim",children:"Beside them, reading along"}),i(jc,{all:e.slice(t)})]})]})}var sg=6,ag={GPS_FIX_TYPE_NO_GPS:"no GPS",GPS_FIX_TYPE_NO_FIX:"no fix",GPS_FIX_TYPE_2D_FIX:"2D",GPS_FIX_TYPE_3D_FIX:"3D",
GPS_FIX_TYPE_DGPS:"DGPS",GPS_FIX_TYPE_RTK_FLOAT:"RTK float",GPS_FIX_TYPE_RTK_FIXED:"RTK fixed",GPS_FIX_TYPE_STATIC:"stat\
ic",GPS_FIX_TYPE_PPP:"PPP"};function Ws(e){return!e||e.fix===null?"\u2013":ag[e.fix]??Ro(e.fix,"GPS_FIX_TYPE_")}var Jc=e=>[
"no GPS","no fix"].includes(Ws(e)),Qc=e=>e?.heading_deg==null?"\u2013":String(Math.round(e.heading_deg)%360);function ef(e){
let t=[["TIMESYNC",e.round_trip_ms?.timesync],["PING",e.round_trip_ms?.ping],["command",e.round_trip_ms?.command]],[n,r]=t.
find(([,o])=>o!=null)??["",null];return r?{text:r.last.toFixed(1),help:`${n}: least ${r.least.toFixed(1)} ms, mean ${r.mean.
toFixed(1)} ms of ${r.count}`}:{text:"\u2013",help:"no TIMESYNC, PING or command has been answered"}}function ug(e){Cn.value=
`${Fn(e)} `,He.value="messages"}var tf=({armed:e})=>e===null?i("span",{class:"dim",children:"\u2013"}):i("span",{class:`\
pill ${e?"armed":""}`,children:e?"ARMED":"disarmed"}),nf=e=>e<=15?"error":e<=30?"warning":"";function rf({percent:e}){return e==
null?null:i("svg",{class:`gauge ${nf(e)}`,viewBox:"0 0 100 10",preserveAspectRatio:"none","aria-hidden":"true",children:[
i("rect",{class:"empty",width:"100",height:"10"}),i("rect",{width:Math.max(0,Math.min(100,e)),height:"10"})]})}function of({
battery:e}){let t=e?.percent;if(t==null)return i(te,{children:"\u2013"});let n=nf(t);return i("span",{class:n,children:[
n!==""&&i(ue,{name:n}),Math.round(t)," %"]})}var lf=({all:e})=>{if(e.length===0)return null;let t=["error","warning","in\
fo"].find(n=>e.some(r=>r.severity===n))??"info";return i("span",{class:`mark ${t}`,title:e.map(n=>n.text).join(`
`),children:[i(ue,{name:t}),e.length]})},sf=({one:e})=>i(te,{children:[i("b",{class:"mono",children:Fn(e)})," ",Ro(e.type,
"MAV_TYPE_")]}),Gs=({one:e})=>i("button",{class:"name",onClick:()=>ug(e),title:"Show its messages",children:i(sf,{one:e})}),
ei=I(null),Us=window.matchMedia("(max-width: 1380px)"),Bs=I(Us.matches);Us.addEventListener("change",()=>{Bs.value=Us.matches});
function cg({one:e}){if(!Bs.value)return i(Gs,{one:e});let t=Fn(e),n=ei.value===t;return i("button",{class:"name","aria-\
expanded":n,title:"Show its state",onClick:()=>{ei.value=n?null:t,n||Rn(".panels.one .name")},children:i(sf,{one:e})})}var ti=({
name:e,title:t,children:n})=>i("div",{class:"pair",title:t,children:[i("dt",{children:e}),i("dd",{children:n})]}),bn=({name:e,
value:t,unit:n,help:r})=>i(ti,{name:e,title:r,children:[t,t!=="\u2013"&&i("span",{class:"unit",children:n})]});function fg({
battery:e}){return i(te,{children:[i(ti,{name:"Battery",children:[i(of,{battery:e}),i(rf,{percent:e?.percent})]}),i(bn,{
name:"Voltage",value:$e(e?.voltage_v,2),unit:"V"}),i(bn,{name:"Current",value:$e(e?.current_a,1),unit:"A"})]})}function pg({
position:e}){return i(te,{children:[i(bn,{name:"Height",help:"above home",value:$e(e?.relative_alt_m,1),unit:"m"}),i(bn,
{name:"Speed",help:"over ground",value:$e(e?.ground_speed_m_s,1),unit:"m/s"}),i(bn,{name:"Heading",value:Qc(e),unit:"\xB0"}),
i(bn,{name:"Latitude",value:$e(e?.lat_deg,6),unit:"\xB0"}),i(bn,{name:"Longitude",value:$e(e?.lon_deg,6),unit:"\xB0"}),i(
bn,{name:"Altitude",help:"above mean sea level",value:$e(e?.alt_m,1),unit:"m"})]})}function dg({one:e}){let{battery:t,gps:n,
position:r}=e,o=ef(e);return i("dl",{class:"figures",children:[i(fg,{battery:t}),i(ti,{name:"GPS",children:i("span",{class:Jc(
n)?"warning":"",children:[Jc(n)&&i(ue,{name:"warning"}),Ws(n)]})}),i(ti,{name:"Satellites",children:n?.satellites??"\u2013"}),
i(bn,{name:"Round trip",help:o.help,value:o.text,unit:"ms"}),i(pg,{position:r})]})}function Xc({one:e}){let t=ds(e);return i(
"article",{class:`panel vehicle ${e.silent?"silent":""}`,children:[i("header",{children:[i("h3",{children:i(Gs,{one:e})}),
i(lf,{all:t}),i("span",{class:"end dim",children:e.silent?i(te,{children:[i(ue,{name:"lost"}),"silent for ",Yt(e.age_s)]}):
`${Tt(e.hz)} /s`})]}),i("p",{class:"mode",children:[i("strong",{children:e.mode??"\u2013"}),i(tf,{armed:e.armed}),i("spa\
n",{class:"end dim",children:[Ro(e.status,"MAV_STATE_")," \xB7 ",Ro(e.autopilot,"MAV_AUTOPILOT_")]})]}),i(dg,{one:e})]})}
var mg=[{key:"vehicle",label:"Vehicle",cell:e=>i(cg,{one:e})},{key:"marks",label:"Alarms",cell:e=>i(lf,{all:ds(e)})},{key:"\
mode",label:"Mode",cell:e=>e.mode??"\u2013"},{key:"armed",label:"Armed",cell:e=>i(tf,{armed:e.armed})},{key:"percent",label:"\
Battery",isNumber:!0,cell:e=>i(te,{children:[i(rf,{percent:e.battery?.percent}),i(of,{battery:e.battery})]})},{key:"volt\
age",label:"V",isNumber:!0,cell:e=>$e(e.battery?.voltage_v,2)},{key:"fix",label:"GPS",cell:e=>Ws(e.gps)},{key:"satellite\
s",label:"Sats",isNumber:!0,cell:e=>e.gps?.satellites??"\u2013"},{key:"height",label:"Height m",isNumber:!0,cell:e=>$e(e.
position?.relative_alt_m,1)},{key:"speed",label:"m/s",isNumber:!0,cell:e=>$e(e.position?.ground_speed_m_s,1)},{key:"head\
ing",label:"Heading",isNumber:!0,cell:e=>Qc(e.position)},{key:"lat",label:"Latitude",isNumber:!0,cell:e=>$e(e.position?.
lat_deg,6)},{key:"lon",label:"Longitude",isNumber:!0,cell:e=>$e(e.position?.lon_deg,6)},{key:"trip",label:"Trip ms",help:"\
round trip",isNumber:!0,cell:e=>ef(e).text},{key:"rate",label:"/s",help:"messages a second",isNumber:!0,cell:e=>Tt(e.hz)},
{key:"age",label:"Age",isNumber:!0,cell:e=>Yt(e.age_s)}];function hg({all:e}){return e.length===0?null:i("ul",{class:"ot\
hers","aria-label":"Other components",children:[e.slice(0,40).map(t=>i("li",{class:t.silent?"silent":"",children:[i(Gs,{
one:t})," ",i("span",{class:"dim",children:t.silent?`silent for ${Yt(t.age_s)}`:`${Tt(t.hz)} /s`})]},Fn(t))),e.length>40&&
i("li",{class:"dim",children:["and ",e.length-40," more"]})]})}function gg({all:e}){let t=Bs.value?e.find(n=>Fn(n)===ei.
value):void 0;return e.length>sg?i(te,{children:[t&&i("div",{class:"panels one",children:i(Xc,{one:t})}),i(Yl,{caption:"\
Vehicles",columns:mg,rows:e,keyOf:Fn,current:t?ei.value:null,classOf:n=>`${n.silent?"silent":""} ${n===t?"open":""}`})]}):
i("div",{class:"panels",children:e.map(n=>i(Xc,{one:n},Fn(n)))})}function af(){Nl.version.value,gt.value;let e=El.value.
filter(ms).sort((n,r)=>n.sys-r.sys||n.comp-r.comp),t=e.filter(n=>n.silent).length;return i("section",{"aria-labelledby":"\
vehicles",children:[i("h2",{id:"vehicles",children:["Vehicles"," ",i("span",{class:"dim",children:[e.length>0&&e.length,
t>0&&`, ${t} silent`]})]}),e.length===0&&i(Xl,{text:"No vehicle has sent a HEARTBEAT yet."}),i(gg,{all:e}),i(hg,{all:El.
value.filter(n=>!ms(n))})]})}function uf(){return Qe(()=>{let e=[Nl.use(),vn.use(),nr.use()];return()=>e.forEach(t=>t())},[]),i(te,{children:[i(af,{}),
i(Zc,{}),i(Wc,{})]})}var js=2e4;function Ho(e,t,n,r){for(;n<r;){let o=n+r>>1;e[o]<t?n=o+1:r=o}return n}var ni=class{times=new Float64Array(2*
js);values=new Float64Array(2*js);first=0;end=0;get length(){return this.end-this.first}get latest(){return this.end>this.
first?this.values[this.end-1]:NaN}get latestTime(){return this.end>this.first?this.times[this.end-1]:-1/0}add(t,n){this.
end===this.times.length&&this.compact(),this.times[this.end]=t,this.values[this.end++]=n,this.length>js&&++this.first}range(t,n){
let r=Math.max(this.first,Ho(this.times,t,this.first,this.end)-1),o=Math.min(this.end,Ho(this.times,n,this.first,this.end)+
2);return[this.times.subarray(r,o),this.values.subarray(r,o)]}clear(){this.first=this.end=0}compact(){this.times.copyWithin(
0,this.first,this.end),this.values.copyWithin(0,this.first,this.end),this.end-=this.first,this.first=0}};function vg(e,t){
let n=[...Array(t.length+1).keys()];for(let r=0;r<e.length;++r){let o=[r+1];for(let l=0;l<t.length;++l)o.push(Math.min(o[l]+
1,n[l+1]+1,n[l]+(e[r]===t[l]?0:1)));n=o}return n[t.length]}function _g(e,t){let n=t.fields.filter(o=>o.type!=="string").
map(o=>({name:o.name,score:vg(e.toLowerCase(),o.name)-(o.name.startsWith(e)?3:0)}));n.sort((o,l)=>o.score-l.score);let r=n[0];
return r&&r.score<=3?`; is it ${r.name}?`:`; it has ${t.fields.map(o=>o.name).join(", ")}`}function bg({name:e,element:t,
at:n},r){let o=r.fields[r.indexOf.get(e)??-1];if(!o)throw new nt(`${r.name} has no field ${e}${_g(e,r)}`,n);if(o.type===
"string")throw new nt(`${e} is text, not a number`,n);if(o.length!==null&&t===null)throw new nt(`${e} is an array: choos\
e an element, from ${e}[0] to ${e}[${o.length-1}]`,n);if(o.length===null&&t!==null)throw new nt(`${e} is not an array`,n);
if(t!==null&&t>=(o.length??0))throw new nt(`${e} has ${o.length} elements, the last is ${e}[${(o.length??1)-1}]`,n)}function xg(e,t,n,r){
let o=e.indexOf.get(n)??-1,l=e.fields[o],a=t[o];return l&&a!==void 0&&Kl(l,a,r)?NaN:yc(t,o,r)}var Uo=class{constructor(t,n){
this.parsed=t;this.own=n;let r=new Set(t.uses.map(o=>o.topic??n));this.topics=r.size>0?[...r]:[n]}parsed;own;topics;latest=new Map;check(t){
for(let n of this.parsed.uses){let r=t(n.topic??this.own);r&&bg(n,r)}}take(t,n,r){return this.latest.set(t,{schema:n,message:Gl(
n,r)}),this.latest.size<this.topics.length?null:this.parsed.formula((o,l,a)=>{let c=this.latest.get(a??this.own);return c?
xg(c.schema,c.message,o,l):NaN})}};function cf(e,t,n){let[,r,o]=e.trim().match(/^(?:(\/\S+)\.)?(\w+)(?:\[\d+\])?$/)??[],
l=n(r??t);return l?.fields[l.indexOf.get(o??"")??-1]?.unit??""}function ff(e,t){try{return t||(Io(e).uses.find(n=>n.topic!==
null)?.topic??"")}catch{return t}}function pf(e,t,n){try{let r=Io(e),o=r.uses.find(l=>l.topic===null&&t==="");return o?new nt(
`choose a topic, or write it here, as in /1/1/VFR_HUD.${o.name}`,o.at):(new Uo(r,t).check(n),null)}catch(r){if(r instanceof
nt)return r;throw r}}var Zt=I(0),ri=e=>at.get(e)?.schema??null,qs=class{constructor(t,n){this.topic=t;this.formula=n;this.attempt(()=>{let r=new Uo(
Io(n),t);this.evaluator=r,this.stopWanting=r.topics.map(o=>Hr(o,(l,a)=>this.take(r,o,l,a)))}),this.compile()}topic;formula;points=new ni;fault=null;unit="";total=0;arrivedMs=0;evaluator=null;schemas=[];stopWanting=[];compile(){
let{evaluator:t}=this,n=t?.topics.map(ri)??[];n.every((r,o)=>r===this.schemas[o])||(this.schemas=n,this.attempt(()=>{t?.
check(ri),this.unit=cf(this.formula,this.topic,ri),this.fault=null}))}interrupt(){this.points.length>0&&!Number.isNaN(this.
points.latest)&&this.points.add(this.points.latestTime,NaN)}stop(){for(let t of this.stopWanting)t()}attempt(t){try{t()}catch(n){
this.fault=n instanceof nt?n:new nt(String(n),0)}}take(t,n,r,o){this.compile();let l=ri(n);if(!l||this.fault)return;let a=t.
take(n,l,r);if(a===null)return;let c=o/1e6;c<this.points.latestTime-5&&this.points.clear(),this.points.add(Math.max(c,this.
points.latestTime),a),++this.total,this.arrivedMs=performance.now(),kt(Zt)}},ir=new Map,xn=e=>`${e.topic} ${e.formula}`,
cn=e=>ir.get(xn(e));function wg(e){let t=new Set(e.map(xn));for(let[n,r]of ir)t.has(n)||(r.stop(),ir.delete(n));for(let n of e)
ir.has(xn(n))||ir.set(xn(n),new qs(n.topic,n.formula));kt(Zt)}function df(){Le(()=>wg(he.value.flat())),Le(()=>{qt.value,
ir.forEach(e=>e.compile())}),Le(()=>{ht.value||ir.forEach(e=>e.interrupt())})}var It=I(null),Ys=new Map,mf=0,hf=()=>he.value.flat().reduce((e,t)=>e+(cn(t)?.total??0),0),gf=()=>Math.max(0,hf()-mf);function yg(){
let e=-1/0;for(let t of he.value.flat()){let n=cn(t);if(!n||n.points.length===0)continue;let r=Math.min((performance.now()-
n.arrivedMs)/1e3,Ln.value/2);e=Math.max(e,n.points.latestTime+r)}return Number.isFinite(e)?e:Date.now()/1e3}function Jt(){
let e=yg();return It.value??{from:e-Ln.value,to:e}}function sr(e=Jt()){if(It.value===null){mf=hf();for(let t of he.value.
flat()){let n=cn(t)?.points.range(-1/0,1/0);n&&Ys.set(xn(t),[n[0].slice(),n[1].slice()])}}It.value=e,kt(Zt)}function Wo(){
Ys.clear(),It.value=null,kt(Zt)}function fn(e,t=.5){let{from:n,to:r}=Jt(),o=Math.min(7200,Math.max(.05,(r-n)*e)),l=n+(r-
n)*t;sr({from:l-o*t,to:l+o*(1-t)})}function Go(e){let{from:t,to:n}=Jt(),r=(n-t)*e;sr({from:t+r,to:n+r})}function ar(e,{from:t,
to:n}){let r=It.value===null?void 0:Ys.get(xn(e));if(!r)return cn(e)?.points.range(t,n)??[new Float64Array,new Float64Array];
let o=Math.max(0,Ho(r[0],t,0,r[0].length)-1),l=Ho(r[0],n,0,r[0].length)+2;return[r[0].subarray(o,l),r[1].subarray(o,l)]}
function vf([e,t],n){if(e.length<=4*n)return[e,t];let r=[];for(let o=0;o<n;++o){let l=Math.floor(o*e.length/n),a=Math.floor(
(o+1)*e.length/n),c=l,d=l;for(let m=l;m<a;++m)t[m]>=t[c]||(c=m),t[m]<=t[d]||(d=m);for(let m of c<d?[c,d]:[d,c])r.push([e[m],
t[m]])}return[Float64Array.from(r,o=>o[0]),Float64Array.from(r,o=>o[1])]}function _f(e,t){let n=document.createElement("a");n.href=URL.createObjectURL(t),n.download=e,n.click(),setTimeout(()=>URL.
revokeObjectURL(n.href),1e4)}var bf=e=>`mavloom-${new Date().toISOString().slice(0,19).replace("T","-").replaceAll(":","")}\
.${e}`,Sg=e=>/[",\n]/.test(e)?`"${e.replaceAll('"','""')}"`:e;function Ks({topic:e,formula:t,scale:n,offset:r}){let o=n===
1?"":` * ${n}`;return`${e} ${t}${o}${r===0?"":` + ${r}`}`}function kg(e){let t=new Map,n=Jt();e.forEach((o,l)=>{let[a,c]=ar(
o,n);for(let d=0;d<a.length;++d){let m=a[d],g=c[d];if(m<n.from||m>n.to||Number.isNaN(g))continue;let _=t.get(m)??e.map(()=>"");
_[l]=String(g*o.scale+o.offset),t.set(m,_)}});let r=[...t].sort(([o],[l])=>o-l).map(([o,l])=>[o.toFixed(6),...l].join(","));
return[["time_s",...e.map(o=>Sg(Ks(o)))].join(","),...r,""].join(`
`)}var xf=e=>_f(bf("csv"),new Blob([kg(e)],{type:"text/csv"}));function wf(e,t){let n=devicePixelRatio||1,r=24*n,o=document.
createElement("canvas");o.width=e.width,o.height=e.height+r;let l=o.getContext("2d");if(!l)return;l.fillStyle=lr("panel"),
l.fillRect(0,0,o.width,o.height),l.drawImage(e,0,r),l.font=`${12*n}px system-ui, sans-serif`,l.textBaseline="middle";let a=12*
n;t.forEach((c,d)=>{l.fillStyle=lr(`series-${d%qr}`),l.fillText(Ks(c),a,r/2),a+=l.measureText(Ks(c)).width+24*n}),o.toBlob(
c=>{c&&_f(bf("png"),c)})}var Mg="uplot",Tg="u-hz",Eg="u-vt",Ag="u-title",Ng="u-wrap",Pg="u-under",Og="u-over",Fg="u-axis",fr="u-off",Cg="u-select",
Dg="u-cursor-x",Lg="u-cursor-y",$g="u-cursor-pt",Rg="u-legend",Ig="u-live",Vg="u-inline",zg="u-series",Hg="u-marker",yf="\
u-label",Ug="u-value",jo="width",qo="height";var Sf="bottom",Xr="left",Zs="right",da="#000",kf=da+"0",Js="mousemove",Mf="mousedown",Xs="mouseup",Tf="mouseenter",Ef="\
mouseleave",Af="dblclick",Wg="resize",Gg="scroll",Nf="change",ai="dppxchange",ma="--",lo=typeof window<"u",ra=lo?document:
null,eo=lo?window:null,Bg=lo?navigator:null,ce,oi;function oa(){let e=devicePixelRatio;ce!=e&&(ce=e,oi&&ia(Nf,oi,oa),oi=
matchMedia(`(min-resolution: ${ce-.001}dppx) and (max-resolution: ${ce+.001}dppx)`),pr(Nf,oi,oa),eo.dispatchEvent(new CustomEvent(
ai)))}function Et(e,t){if(t!=null){let n=e.classList;!n.contains(t)&&n.add(t)}}function la(e,t){let n=e.classList;n.contains(
t)&&n.remove(t)}function Se(e,t,n){e.style[t]=n+"px"}function Xt(e,t,n,r){let o=ra.createElement(e);return t!=null&&Et(o,
t),n?.insertBefore(o,r),o}function Vt(e,t){return Xt("div",e,t)}var Pf=new WeakMap;function pn(e,t,n,r,o){let l="transla\
te("+t+"px,"+n+"px)",a=Pf.get(e);l!=a&&(e.style.transform=l,Pf.set(e,l),t<0||n<0||t>r||n>o?Et(e,fr):la(e,fr))}var Of=new WeakMap;
function Ff(e,t,n){let r=t+n,o=Of.get(e);r!=o&&(Of.set(e,r),e.style.background=t,e.style.borderColor=n)}var Cf=new WeakMap;
function Df(e,t,n,r){let o=t+""+n,l=Cf.get(e);o!=l&&(Cf.set(e,o),e.style.height=n+"px",e.style.width=t+"px",e.style.marginLeft=
r?-t/2+"px":0,e.style.marginTop=r?-n/2+"px":0)}var ha={passive:!0},jg={...ha,capture:!0};function pr(e,t,n,r){t.addEventListener(
e,n,r?jg:ha)}function ia(e,t,n,r){t.removeEventListener(e,n,ha)}lo&&oa();function Qt(e,t,n,r){let o;n=n||0,r=r||t.length-
1;let l=r<=2147483647;for(;r-n>1;)o=l?n+r>>1:At((n+r)/2),t[o]<e?n=o:r=o;return e-t[n]<=t[r]-e?n:r}function ap(e){return(n,r,o)=>{
let l=-1,a=-1;for(let c=r;c<=o;c++)if(e(n[c])){l=c;break}for(let c=o;c>=r;c--)if(e(n[c])){a=c;break}return[l,a]}}var up=e=>e!=
null,cp=e=>e!=null&&e>0,fi=ap(up),qg=ap(cp);function Yg(e,t,n,r=0,o=!1){let l=o?qg:fi,a=o?cp:up;[t,n]=l(e,t,n);let c=e[t],
d=e[t];if(t>-1)if(r==1)c=e[t],d=e[n];else if(r==-1)c=e[n],d=e[t];else for(let m=t;m<=n;m++){let g=e[m];a(g)&&(g<c?c=g:g>
d&&(d=g))}return[c??ge,d??-ge]}function pi(e,t,n,r){let o=Rf(e),l=Rf(t);e==t&&(o==-1?(e*=n,t/=n):(e/=n,t*=n));let a=n==10?
wn:fp,c=o==1?At:zt,d=l==1?zt:At,m=c(a(We(e))),g=d(a(We(t))),_=to(n,m),x=to(n,g);return n==10&&(m<0&&(_=ve(_,-m)),g<0&&(x=
ve(x,-g))),r||n==2?(e=_*o,t=x*l):(e=hp(e,_),t=di(t,x)),[e,t]}function ga(e,t,n,r){let o=pi(e,t,n,r);return e==0&&(o[0]=0),
t==0&&(o[1]=0),o}var va=.1,Lf={mode:3,pad:va},Ko={pad:0,soft:null,mode:0},Kg={min:Ko,max:Ko};function ui(e,t,n,r){return mi(
n)?$f(e,t,n):(Ko.pad=n,Ko.soft=r?0:null,Ko.mode=r?3:0,$f(e,t,Kg))}function se(e,t){return e??t}function Zg(e,t,n){for(t=
se(t,0),n=se(n,e.length-1);t<=n;){if(e[t]!=null)return!0;t++}return!1}function $f(e,t,n){let r=n.min,o=n.max,l=se(r.pad,
0),a=se(o.pad,0),c=se(r.hard,-ge),d=se(o.hard,ge),m=se(r.soft,ge),g=se(o.soft,-ge),_=se(r.mode,0),x=se(o.mode,0),v=t-e,k=wn(
v),N=ct(We(e),We(t)),A=wn(N),F=We(A-k);(v<1e-24||F>10)&&(v=0,(e==0||t==0)&&(v=1e-24,_==2&&m!=ge&&(l=0),x==2&&g!=-ge&&(a=
0)));let w=v||N||1e3,P=wn(w),S=to(10,At(P)),K=w*(v==0?e==0?.1:1:l),$=ve(hp(e-K,S/10),24),Z=e>=m&&(_==1||_==3&&$<=m||_==2&&
$>=m)?m:ge,G=ct(c,$<Z&&e>=Z?Z:en(Z,$)),X=w*(v==0?t==0?.1:1:a),W=ve(di(t+X,S/10),24),E=t<=g&&(x==1||x==3&&W>=g||x==2&&W<=
g)?g:-ge,B=en(d,W>E&&t<=E?E:ct(E,W));return G==B&&G==0&&(B=100),[G,B]}var Jg=new Intl.NumberFormat(lo?Bg.language:"en-US"),
_a=e=>Jg.format(e),Nt=Math,si=Nt.PI,We=Nt.abs,At=Nt.floor,Ue=Nt.round,zt=Nt.ceil,en=Nt.min,ct=Nt.max,to=Nt.pow,Rf=Nt.sign,
wn=Nt.log10,fp=Nt.log2,Xg=(e,t=1)=>Nt.sinh(e)*t,Qs=(e,t=1)=>Nt.asinh(e/t),ge=1/0;function If(e){return(wn((e^e>>31)-(e>>
31))|0)+1}function sa(e,t,n){return en(ct(e,t),n)}function pp(e){return typeof e=="function"}function ne(e){return pp(e)?
e:()=>e}var Qg=()=>{},dp=e=>e,mp=(e,t)=>t,ev=e=>null,Vf=e=>!0,zf=(e,t)=>e==t,tv=/\.\d*?(?=9{6,}|0{6,})/gm,dr=e=>{if(vp(e)||
Vn.has(e))return e;let t=`${e}`,n=t.match(tv);if(n==null)return e;let r=n[0].length-1;if(t.indexOf("e-")!=-1){let[o,l]=t.
split("e");return+`${dr(o)}e${l}`}return ve(e,r)};function ur(e,t){return dr(ve(dr(e/t))*t)}function di(e,t){return dr(zt(
dr(e/t))*t)}function hp(e,t){return dr(At(dr(e/t))*t)}function ve(e,t=0){if(vp(e))return e;let n=10**t,r=e*n*(1+Number.EPSILON);
return Ue(r)/n}var Vn=new Map;function gp(e){return((""+e).split(".")[1]||"").length}function Jo(e,t,n,r){let o=[],l=r.map(
gp);for(let a=t;a<n;a++){let c=We(a),d=ve(to(e,a),c);for(let m=0;m<r.length;m++){let g=e==10?+`${r[m]}e${a}`:r[m]*d,_=(a>=
0?0:c)+(a>=l[m]?0:l[m]),x=e==10?g:ve(g,_);o.push(x),Vn.set(x,_)}}return o}var Zo={},ba=[],no=[null,null],In=Array.isArray,
vp=Number.isInteger,nv=e=>e===void 0;function Hf(e){return typeof e=="string"}function mi(e){let t=!1;if(e!=null){let n=e.
constructor;t=n==null||n==Object}return t}function rv(e){return e!=null&&typeof e=="object"}var ov=Object.getPrototypeOf(
Uint8Array),_p="__proto__";function ro(e,t=mi){let n;if(In(e)){let r=e.find(o=>o!=null);if(In(r)||t(r)){n=Array(e.length);
for(let o=0;o<e.length;o++)n[o]=ro(e[o],t)}else n=e.slice()}else if(e instanceof ov)n=e.slice();else if(t(e)){n={};for(let r in e)
r!=_p&&(n[r]=ro(e[r],t))}else n=e;return n}function Re(e){let t=arguments;for(let n=1;n<t.length;n++){let r=t[n];for(let o in r)
o!=_p&&(mi(e[o])?Re(e[o],ro(r[o])):e[o]=ro(r[o]))}return e}var lv=0,iv=1,sv=2;function av(e,t,n){for(let r=0,o,l=-1;r<t.
length;r++){let a=t[r];if(a>l){for(o=a-1;o>=0&&e[o]==null;)e[o--]=null;for(o=a+1;o<n&&e[o]==null;)e[l=o++]=null}}}function uv(e,t){
if(pv(e)){let a=e[0].slice();for(let c=1;c<e.length;c++)a.push(...e[c].slice(1));return dv(a[0])||(a=fv(a)),a}let n=new Set;
for(let a=0;a<e.length;a++){let d=e[a][0],m=d.length;for(let g=0;g<m;g++)n.add(d[g])}let r=[Array.from(n).sort((a,c)=>a-
c)],o=r[0].length,l=new Map;for(let a=0;a<o;a++)l.set(r[0][a],a);for(let a=0;a<e.length;a++){let c=e[a],d=c[0];for(let m=1;m<
c.length;m++){let g=c[m],_=Array(o).fill(void 0),x=t?t[a][m]:iv,v=[];for(let k=0;k<g.length;k++){let N=g[k],A=l.get(d[k]);
N===null?x!=lv&&(_[A]=N,x==sv&&v.push(A)):_[A]=N}av(_,v,o),r.push(_)}}return r}var cv=typeof queueMicrotask>"u"?e=>Promise.
resolve().then(e):queueMicrotask;function fv(e){let t=e[0],n=t.length,r=Array(n);for(let l=0;l<r.length;l++)r[l]=l;r.sort(
(l,a)=>t[l]-t[a]);let o=[];for(let l=0;l<e.length;l++){let a=e[l],c=Array(n);for(let d=0;d<n;d++)c[d]=a[r[d]];o.push(c)}
return o}function pv(e){let t=e[0][0],n=t.length;for(let r=1;r<e.length;r++){let o=e[r][0];if(o.length!=n)return!1;if(o!=
t){for(let l=0;l<n;l++)if(o[l]!=t[l])return!1}}return!0}function dv(e,t=100){let n=e.length;if(n<=1)return!0;let r=0,o=n-
1;for(;r<=o&&e[r]==null;)r++;for(;o>=r&&e[o]==null;)o--;if(o<=r)return!0;let l=ct(1,At((o-r+1)/t));for(let a=e[r],c=r+l;c<=
o;c+=l){let d=e[c];if(d!=null){if(d<=a)return!1;a=d}}return!0}var bp=["January","February","March","April","May","June",
"July","August","September","October","November","December"],xp=["Sunday","Monday","Tuesday","Wednesday","Thursday","Fri\
day","Saturday"];function wp(e){return e.slice(0,3)}var mv=xp.map(wp),hv=bp.map(wp),gv={MMMM:bp,MMM:hv,WWWW:xp,WWW:mv};function Bo(e){
return(e<10?"0":"")+e}function vv(e){return(e<10?"00":e<100?"0":"")+e}var _v={YYYY:e=>e.getFullYear(),YY:e=>(e.getFullYear()+
"").slice(2),MMMM:(e,t)=>t.MMMM[e.getMonth()],MMM:(e,t)=>t.MMM[e.getMonth()],MM:e=>Bo(e.getMonth()+1),M:e=>e.getMonth()+
1,DD:e=>Bo(e.getDate()),D:e=>e.getDate(),WWWW:(e,t)=>t.WWWW[e.getDay()],WWW:(e,t)=>t.WWW[e.getDay()],HH:e=>Bo(e.getHours()),
H:e=>e.getHours(),h:e=>{let t=e.getHours();return t==0?12:t>12?t-12:t},AA:e=>e.getHours()>=12?"PM":"AM",aa:e=>e.getHours()>=
12?"pm":"am",a:e=>e.getHours()>=12?"p":"a",mm:e=>Bo(e.getMinutes()),m:e=>e.getMinutes(),ss:e=>Bo(e.getSeconds()),s:e=>e.
getSeconds(),fff:e=>vv(e.getMilliseconds())};function xa(e,t){t=t||gv;let n=[],r=/\{([a-z]+)\}|[^{]+/gi,o;for(;o=r.exec(
e);)n.push(o[0][0]=="{"?_v[o[1]]:o[0]);return l=>{let a="";for(let c=0;c<n.length;c++)a+=typeof n[c]=="string"?n[c]:n[c](
l,t);return a}}var bv=new Intl.DateTimeFormat().resolvedOptions().timeZone;function xv(e,t){let n;return t=="UTC"||t=="E\
tc/UTC"?n=new Date(+e+e.getTimezoneOffset()*6e4):t==bv?n=e:(n=new Date(e.toLocaleString("en-US",{timeZone:t})),n.setMilliseconds(
e.getMilliseconds())),n}var yp=e=>e%1==0,ci=[1,2,2.5,5],wv=Jo(10,-32,0,ci),Sp=Jo(10,0,32,ci),yv=Sp.filter(yp),cr=wv.concat(
Sp),wa=`
`,kp="{YYYY}",Uf=wa+kp,Mp="{M}/{D}",Yo=wa+Mp,li=Yo+"/{YY}",Tp="{aa}",Sv="{h}:{mm}",Qr=Sv+Tp,Wf=wa+Qr,Gf=":{ss}",pe=null;
function Ep(e){let t=e*1e3,n=t*60,r=n*60,o=r*24,l=o*30,a=o*365,d=(e==1?Jo(10,0,3,ci).filter(yp):Jo(10,-3,0,ci)).concat([
t,t*5,t*10,t*15,t*30,n,n*5,n*10,n*15,n*30,r,r*2,r*3,r*4,r*6,r*8,r*12,o,o*2,o*3,o*4,o*5,o*6,o*7,o*8,o*9,o*10,o*15,l,l*2,l*
3,l*4,l*6,a,a*2,a*5,a*10,a*25,a*50,a*100]),m=[[a,kp,pe,pe,pe,pe,pe,pe,1],[o*28,"{MMM}",Uf,pe,pe,pe,pe,pe,1],[o,Mp,Uf,pe,
pe,pe,pe,pe,1],[r,"{h}"+Tp,li,pe,Yo,pe,pe,pe,1],[n,Qr,li,pe,Yo,pe,pe,pe,1],[t,Gf,li+" "+Qr,pe,Yo+" "+Qr,pe,Wf,pe,1],[e,Gf+
".{fff}",li+" "+Qr,pe,Yo+" "+Qr,pe,Wf,pe,1]];function g(_){return(x,v,k,N,A,F)=>{let w=[],P=A>=a,S=A>=l&&A<a,K=_(k),$=ve(
K*e,3),Z=ea(K.getFullYear(),P?0:K.getMonth(),S||P?1:K.getDate()),G=ve(Z*e,3);if(S||P){let X=S?A/l:0,W=P?A/a:0,E=$==G?$:ve(
ea(Z.getFullYear()+W,Z.getMonth()+X,1)*e,3),B=new Date(Ue(E/e)),C=B.getFullYear(),q=B.getMonth();for(let U=0;E<=N;U++){let re=ea(
C+W*U,q+X*U,1),H=re-_(ve(re*e,3));E=ve((+re+H)*e,3),E<=N&&w.push(E)}}else{let X=A>=o?o:A,W=At(k)-At($),E=G+W+di($-G,X);w.
push(E);let B=_(E),C=B.getHours()+B.getMinutes()/n+B.getSeconds()/r,q=A/r,U=x.axes[v]._space,re=F/U;for(;E=ve(E+A,e==1?0:
3),!(E>N);)if(q>1){let H=At(ve(C+q,6))%24,le=_(E).getHours()-H;le>1&&(le=-1),E-=le*r,C=(C+q)%24;let de=w[w.length-1];ve(
(E-de)/A,3)*re>=.7&&w.push(E)}else w.push(E)}return w}}return[d,m,g]}var[kv,Mv,Tv]=Ep(1),[Ev,Av,Nv]=Ep(.001);Jo(2,-53,53,
[1]);function Bf(e,t){return e.map(n=>n.map((r,o)=>o==0||o==8||r==null?r:t(o==1||n[8]==0?r:n[1]+r)))}function jf(e,t){return(n,r,o,l,a)=>{
let c=t.find(k=>a>=k[0])||t[t.length-1],d,m,g,_,x,v;return r.map(k=>{let N=e(k),A=N.getFullYear(),F=N.getMonth(),w=N.getDate(),
P=N.getHours(),S=N.getMinutes(),K=N.getSeconds(),$=A!=d&&c[2]||F!=m&&c[3]||w!=g&&c[4]||P!=_&&c[5]||S!=x&&c[6]||K!=v&&c[7]||
c[1];return d=A,m=F,g=w,_=P,x=S,v=K,$(N)})}}function Pv(e,t){let n=xa(t);return(r,o,l,a,c)=>o.map(d=>n(e(d)))}function ea(e,t,n){
return new Date(e,t,n)}function qf(e,t){return t(e)}var Ov="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function Yf(e,t){return(n,r,o,l)=>l==
null?ma:t(e(r))}function Fv(e,t){let n=e.series[t];return n.width?n.stroke(e,t):n.points.width?n.points.stroke(e,t):null}
function Cv(e,t){return e.series[t].fill(e,t)}var Dv={show:!0,live:!0,isolate:!1,mount:Qg,markers:{show:!0,width:2,stroke:Fv,
fill:Cv,dash:"solid"},idx:null,idxs:null,values:[]};function Lv(e,t){let n=e.cursor.points,r=Vt(),o=n.size(e,t);Se(r,jo,
o),Se(r,qo,o);let l=o/-2;Se(r,"marginLeft",l),Se(r,"marginTop",l);let a=n.width(e,t,o);return a&&Se(r,"borderWidth",a),r}
function $v(e,t){let n=e.series[t].points;return n._fill||n._stroke}function Rv(e,t){let n=e.series[t].points;return n._stroke||
n._fill}function Iv(e,t){return e.series[t].points.size}var ta=[0,0];function Vv(e,t,n){return ta[0]=t,ta[1]=n,ta}function ii(e,t,n,r=!0){
return o=>{o.button==0&&(!r||o.target==t)&&n(o)}}function na(e,t,n,r=!0){return o=>{(!r||o.target==t)&&n(o)}}var zv={show:!0,
x:!0,y:!0,lock:!1,move:Vv,points:{one:!1,show:Lv,size:Iv,width:0,stroke:Rv,fill:$v},bind:{mousedown:ii,mouseup:ii,click:ii,
dblclick:ii,mousemove:na,mouseleave:na,mouseenter:na},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(e,t)=>{t.stopPropagation(),
t.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(e,t,n,r,o)=>r-o,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},
left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Ap={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},ya=Re({},Ap,
{filter:mp}),Np=Re({},ya,{size:10}),Pp=Re({},Ap,{show:!1}),Sa='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helve\
tica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',
Op="bold "+Sa,Fp=1.5,Kf={show:!0,scale:"x",stroke:da,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Op,
side:2,grid:ya,ticks:Np,border:Pp,font:Sa,lineGap:Fp,rotate:0},Hv="Value",Uv="Time",Zf={show:!0,scale:"x",auto:!1,sorted:1,
min:ge,max:-ge,idxs:[]};function Wv(e,t,n,r,o){return t.map(l=>l==null?"":_a(l))}function Gv(e,t,n,r,o,l,a){let c=[],d=Vn.
get(o)||0;n=a?n:ve(di(n,o),d);for(let m=n;m<=r;m=ve(m+o,d))c.push(Object.is(m,-0)?0:m);return c}function aa(e,t,n,r,o,l,a){
let c=[],d=e.scales[e.axes[t].scale].log,m=d==10?wn:fp,g=At(m(n));o=to(d,g),d==10&&(o=cr[Qt(o,cr)]);let _=n,x=o*d;d==10&&
(x=cr[Qt(x,cr)]);do c.push(_),_=_+o,d==10&&!Vn.has(_)&&(_=ve(_,Vn.get(o))),_>=x&&(o=_,x=o*d,d==10&&(x=cr[Qt(x,cr)]));while(_<=
r);return c}function Bv(e,t,n,r,o,l,a){let d=e.scales[e.axes[t].scale].asinh,m=r>d?aa(e,t,ct(d,n),r,o):[d],g=r>=0&&n<=0?
[0]:[];return(n<-d?aa(e,t,ct(d,-r),-n,o):[d]).reverse().map(x=>-x).concat(g,m)}var Cp=/./,jv=/[12357]/,qv=/[125]/,Jf=/1/,
ua=(e,t,n,r)=>e.map((o,l)=>t==4&&o==0||l%r==0&&n.test(o.toExponential()[o<0?1:0])?o:null);function Yv(e,t,n,r,o){let l=e.
axes[n],a=l.scale,c=e.scales[a],d=e.valToPos,m=l._space,g=d(10,a),_=d(9,a)-g>=m?Cp:d(7,a)-g>=m?jv:d(5,a)-g>=m?qv:Jf;if(_==
Jf){let x=We(d(1,a)-g);if(x<m)return ua(t.slice().reverse(),c.distr,_,zt(m/x)).reverse()}return ua(t,c.distr,_,1)}function Kv(e,t,n,r,o){
let l=e.axes[n],a=l.scale,c=l._space,d=e.valToPos,m=We(d(1,a)-d(2,a));return m<c?ua(t.slice().reverse(),3,Cp,zt(c/m)).reverse():
t}function Zv(e,t,n,r){return r==null?ma:t==null?"":_a(t)}var Xf={show:!0,scale:"y",stroke:da,space:30,gap:5,alignTo:1,size:50,
labelGap:0,labelSize:30,labelFont:Op,side:3,grid:ya,ticks:Np,border:Pp,font:Sa,lineGap:Fp,rotate:0};function Jv(e,t){let n=3+
(e||1)*2;return ve(n*t,3)}function Xv(e,t){let{scale:n,idxs:r}=e.series[0],o=e._data[0],l=e.valToPos(o[r[0]],n,!0),a=e.valToPos(
o[r[1]],n,!0),c=We(a-l),d=e.series[t],m=c/(d.points.space*ce);return r[1]-r[0]<=m}var Qf={scale:null,auto:!0,sorted:0,min:ge,
max:-ge},Dp=(e,t,n,r,o)=>o,ep={show:!0,auto:!0,sorted:0,gaps:Dp,alpha:1,facets:[Re({},Qf,{scale:"x"}),Re({},Qf,{scale:"y"})]},
tp={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:Dp,alpha:1,points:{show:Xv,filter:null},values:null,min:ge,max:-ge,
idxs:[],path:null,clip:null};function Qv(e,t,n,r,o){return n/10}var Lp={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,
max:null,dir:1,ori:0},e0=Re({},Lp,{time:!1,ori:1}),np={};function $p(e,t){let n=np[e];return n||(n={key:e,plots:[],sub(r){
n.plots.push(r)},unsub(r){n.plots=n.plots.filter(o=>o!=r)},pub(r,o,l,a,c,d,m){for(let g=0;g<n.plots.length;g++)n.plots[g]!=
o&&n.plots[g].pub(r,o,l,a,c,d,m)}},e!=null&&(np[e]=n)),n}var oo=1,ca=2;function mr(e,t,n){let r=e.mode,o=e.series[t],l=r==
2?e._data[t]:e._data,a=e.scales,c=e.bbox,d=l[0],m=r==2?l[1]:l[t],g=r==2?a[o.facets[0].scale]:a[e.series[0].scale],_=r==2?
a[o.facets[1].scale]:a[o.scale],x=c.left,v=c.top,k=c.width,N=c.height,A=e.valToPosH,F=e.valToPosV;return g.ori==0?n(o,d,
m,g,_,A,F,x,v,k,N,gi,io,_i,Ip,zp):n(o,d,m,g,_,F,A,v,x,N,k,vi,so,Ta,Vp,Hp)}function ka(e,t){let n=0,r=0,o=se(e.bands,ba);
for(let l=0;l<o.length;l++){let a=o[l];a.series[0]==t?n=a.dir:a.series[1]==t&&(a.dir==1?r|=1:r|=2)}return[n,r==1?-1:r==2?
1:r==3?2:0]}function t0(e,t,n,r,o){let l=e.mode,a=e.series[t],c=l==2?a.facets[1].scale:a.scale,d=e.scales[c];return o==-1?
d.min:o==1?d.max:d.distr==3?d.dir==1?d.min:d.max:0}function yn(e,t,n,r,o,l){return mr(e,t,(a,c,d,m,g,_,x,v,k,N,A)=>{let F=a.
pxRound,w=m.dir*(m.ori==0?1:-1),P=m.ori==0?io:so,S,K;w==1?(S=n,K=r):(S=r,K=n);let $=F(_(c[S],m,N,v)),Z=F(x(d[S],g,A,k)),
G=F(_(c[K],m,N,v)),X=F(x(l==1?g.max:g.min,g,A,k)),W=new Path2D(o);return P(W,G,X),P(W,$,X),P(W,$,Z),W})}function hi(e,t,n,r,o,l){
let a=null;if(e.length>0){a=new Path2D;let c=t==0?_i:Ta,d=n;for(let _=0;_<e.length;_++){let x=e[_];if(x[1]>x[0]){let v=x[0]-
d;v>0&&c(a,d,r,v,r+l),d=x[1]}}let m=n+o-d,g=10;m>0&&c(a,d,r-g/2,m,r+l+g)}return a}function n0(e,t,n){let r=e[e.length-1];
r&&r[0]==t?r[1]=n:e.push([t,n])}function Ma(e,t,n,r,o,l,a){let c=[],d=e.length;for(let m=o==1?n:r;m>=n&&m<=r;m+=o)if(t[m]===
null){let _=m,x=m;if(o==1)for(;++m<=r&&t[m]===null;)x=m;else for(;--m>=n&&t[m]===null;)x=m;let v=l(e[_]),k=x==_?v:l(e[x]),
N=_-o;v=a<=0&&N>=0&&N<d?l(e[N]):v;let F=x+o;k=a>=0&&F>=0&&F<d?l(e[F]):k,k>=v&&c.push([v,k])}return c}function rp(e){return e==
0?dp:e==1?Ue:t=>ur(t,e)}function Rp(e){let t=e==0?gi:vi,n=e==0?(o,l,a,c,d,m)=>{o.arcTo(l,a,c,d,m)}:(o,l,a,c,d,m)=>{o.arcTo(
a,l,d,c,m)},r=e==0?(o,l,a,c,d)=>{o.rect(l,a,c,d)}:(o,l,a,c,d)=>{o.rect(a,l,d,c)};return(o,l,a,c,d,m=0,g=0)=>{m==0&&g==0?
r(o,l,a,c,d):(m=en(m,c/2,d/2),g=en(g,c/2,d/2),t(o,l+m,a),n(o,l+c,a,l+c,a+d,m),n(o,l+c,a+d,l,a+d,g),n(o,l,a+d,l,a,g),n(o,
l,a,l+c,a,m),o.closePath())}}var gi=(e,t,n)=>{e.moveTo(t,n)},vi=(e,t,n)=>{e.moveTo(n,t)},io=(e,t,n)=>{e.lineTo(t,n)},so=(e,t,n)=>{
e.lineTo(n,t)},_i=Rp(0),Ta=Rp(1),Ip=(e,t,n,r,o,l)=>{e.arc(t,n,r,o,l)},Vp=(e,t,n,r,o,l)=>{e.arc(n,t,r,o,l)},zp=(e,t,n,r,o,l,a)=>{
e.bezierCurveTo(t,n,r,o,l,a)},Hp=(e,t,n,r,o,l,a)=>{e.bezierCurveTo(n,t,o,r,a,l)};function Up(e){return(t,n,r,o,l)=>mr(t,
n,(a,c,d,m,g,_,x,v,k,N,A)=>{let{pxRound:F,points:w}=a,P,S;m.ori==0?(P=gi,S=Ip):(P=vi,S=Vp);let K=ve(w.width*ce,3),$=(w.size-
w.width)/2*ce,Z=ve($*2,3),G=new Path2D,X=new Path2D,{left:W,top:E,width:B,height:C}=t.bbox;_i(X,W-Z,E-Z,B+Z*2,C+Z*2);let q=U=>{
if(d[U]!=null){let re=F(_(c[U],m,N,v)),H=F(x(d[U],g,A,k));P(G,re+$,H),S(G,re,H,$,0,si*2)}};if(l)l.forEach(q);else for(let U=r;U<=
o;U++)q(U);return{stroke:K>0?G:null,fill:G,clip:X,flags:oo|ca}})}function Wp(e){return(t,n,r,o,l,a)=>{r!=o&&(l!=r&&a!=r&&
e(t,n,r),l!=o&&a!=o&&e(t,n,o),e(t,n,a))}}var r0=Wp(io),o0=Wp(so);function Gp(e){let t=se(e?.alignGaps,0);return(n,r,o,l)=>mr(
n,r,(a,c,d,m,g,_,x,v,k,N,A)=>{[o,l]=fi(d,o,l);let F=a.pxRound,w=C=>F(_(C,m,N,v)),P=C=>F(x(C,g,A,k)),S,K;m.ori==0?(S=io,K=
r0):(S=so,K=o0);let $=m.dir*(m.ori==0?1:-1),Z={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:oo},G=Z.stroke,
X=!1;if(l-o>=N*4){let C=V=>n.posToVal(V,m.key,!0),q=null,U=null,re,H,ft,ke=w(c[$==1?o:l]),le=w(c[o]),de=w(c[l]),Q=C($==1?
le+1:de-1);for(let V=$==1?o:l;V>=o&&V<=l;V+=$){let Ie=c[V],Me=($==1?Ie<Q:Ie>Q)?ke:w(Ie),fe=d[V];Me==ke?fe!=null?(H=fe,q==
null?(S(G,Me,P(H)),re=q=U=H):H<q?q=H:H>U&&(U=H)):fe===null&&(X=!0):(q!=null&&K(G,ke,P(q),P(U),P(re),P(H)),fe!=null?(H=fe,
S(G,Me,P(H)),q=U=re=H):(q=U=null,fe===null&&(X=!0)),ke=Me,Q=C(ke+$))}q!=null&&q!=U&&ft!=ke&&K(G,ke,P(q),P(U),P(re),P(H))}else
for(let C=$==1?o:l;C>=o&&C<=l;C+=$){let q=d[C];q===null?X=!0:q!=null&&S(G,w(c[C]),P(q))}let[E,B]=ka(n,r);if(a.fill!=null||
E!=0){let C=Z.fill=new Path2D(G),q=a.fillTo(n,r,a.min,a.max,E),U=P(q),re=w(c[o]),H=w(c[l]);$==-1&&([H,re]=[re,H]),S(C,H,
U),S(C,re,U)}if(!a.spanGaps){let C=[];X&&C.push(...Ma(c,d,o,l,$,w,t)),Z.gaps=C=a.gaps(n,r,o,l,C),Z.clip=hi(C,m.ori,v,k,N,
A)}return B!=0&&(Z.band=B==2?[yn(n,r,o,l,G,-1),yn(n,r,o,l,G,1)]:yn(n,r,o,l,G,B)),Z})}function l0(e){let t=se(e.align,1),
n=se(e.ascDesc,!1),r=se(e.alignGaps,0),o=se(e.extend,!1);return(l,a,c,d)=>mr(l,a,(m,g,_,x,v,k,N,A,F,w,P)=>{[c,d]=fi(_,c,
d);let S=m.pxRound,{left:K,width:$}=l.bbox,Z=le=>S(k(le,x,w,A)),G=le=>S(N(le,v,P,F)),X=x.ori==0?io:so,W={stroke:new Path2D,
fill:null,clip:null,band:null,gaps:null,flags:oo},E=W.stroke,B=x.dir*(x.ori==0?1:-1),C=G(_[B==1?c:d]),q=Z(g[B==1?c:d]),U=q,
re=q;o&&t==-1&&(re=K,X(E,re,C)),X(E,q,C);for(let le=B==1?c:d;le>=c&&le<=d;le+=B){let de=_[le];if(de==null)continue;let Q=Z(
g[le]),V=G(de);t==1?X(E,Q,C):X(E,U,V),X(E,Q,V),C=V,U=Q}let H=U;o&&t==1&&(H=K+$,X(E,H,C));let[ft,ke]=ka(l,a);if(m.fill!=null||
ft!=0){let le=W.fill=new Path2D(E),de=m.fillTo(l,a,m.min,m.max,ft),Q=G(de);X(le,H,Q),X(le,re,Q)}if(!m.spanGaps){let le=[];
le.push(...Ma(g,_,c,d,B,Z,r));let de=m.width*ce/2,Q=n||t==1?de:-de,V=n||t==-1?-de:de;le.forEach(Ie=>{Ie[0]+=Q,Ie[1]+=V}),
W.gaps=le=m.gaps(l,a,c,d,le),W.clip=hi(le,x.ori,A,F,w,P)}return ke!=0&&(W.band=ke==2?[yn(l,a,c,d,E,-1),yn(l,a,c,d,E,1)]:
yn(l,a,c,d,E,ke)),W})}function op(e,t,n,r,o,l,a=ge){if(e.length>1){let c=null;for(let d=0,m=1/0;d<e.length;d++)if(t[d]!==
void 0){if(c!=null){let g=We(e[d]-e[c]);g<m&&(m=g,a=We(n(e[d],r,o,l)-n(e[c],r,o,l)))}c=d}}return a}function i0(e){e=e||Zo;
let t=se(e.size,[.6,ge,1]),n=e.align||0,r=e.gap||0,o=e.radius;o=o==null?[0,0]:typeof o=="number"?[o,0]:o;let l=ne(o),a=1-
t[0],c=se(t[1],ge),d=se(t[2],1),m=se(e.disp,Zo),g=se(e.each,v=>{}),{fill:_,stroke:x}=m;return(v,k,N,A)=>mr(v,k,(F,w,P,S,K,$,Z,G,X,W,E)=>{
let B=F.pxRound,C=n,q=r*ce,U=c*ce,re=d*ce,H,ft;S.ori==0?[H,ft]=l(v,k):[ft,H]=l(v,k);let ke=S.dir*(S.ori==0?1:-1),le=S.ori==
0?_i:Ta,de=S.ori==0?g:(L,_e,Ve,_r,Un,nn,Wn)=>{g(L,_e,Ve,Un,_r,Wn,nn)},Q=se(v.bands,ba).find(L=>L.series[0]==k),V=Q!=null?
Q.dir:0,Ie=F.fillTo(v,k,F.min,F.max,V),rt=B(Z(Ie,K,E,X)),Me,fe,Ut,bt=W,Ne=B(F.width*ce),tn=!1,dn=null,Pt=null,kn=null,hr=null;
_!=null&&(Ne==0||x!=null)&&(tn=!0,dn=_.values(v,k,N,A),Pt=new Map,new Set(dn).forEach(L=>{L!=null&&Pt.set(L,new Path2D)}),
Ne>0&&(kn=x.values(v,k,N,A),hr=new Map,new Set(kn).forEach(L=>{L!=null&&hr.set(L,new Path2D)})));let{x0:gr,size:uo}=m;if(gr!=
null&&uo!=null){C=1,w=gr.values(v,k,N,A),gr.unit==2&&(w=w.map(Ve=>v.posToVal(G+Ve*W,S.key,!0)));let L=uo.values(v,k,N,A);
uo.unit==2?fe=L[0]*W:fe=$(L[0],S,W,G)-$(0,S,W,G),bt=op(w,P,$,S,W,G,bt),Ut=bt-fe+q}else bt=op(w,P,$,S,W,G,bt),Ut=bt*a+q,fe=
bt-Ut;Ut<1&&(Ut=0),Ne>=fe/2&&(Ne=0),Ut<5&&(B=dp);let Qo=Ut>0,zn=bt-Ut-(Qo?Ne:0);fe=B(sa(zn,re,U)),Me=(C==0?fe/2:C==ke?0:
fe)-C*ke*((C==0?q/2:0)+(Qo?Ne/2:0));let ot={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},vr=tn?null:new Path2D,
mn=null;if(Q!=null)mn=v.data[Q.series[1]];else{let{y0:L,y1:_e}=m;L!=null&&_e!=null&&(P=_e.values(v,k,N,A),mn=L.values(v,
k,N,A))}let Hn=H*fe,J=ft*fe;for(let L=ke==1?N:A;L>=N&&L<=A;L+=ke){let _e=P[L];if(_e==null)continue;if(mn!=null){let pt=mn[L]??
0;if(_e-pt==0)continue;rt=Z(pt,K,E,X)}let Ve=S.distr!=2||m!=null?w[L]:L,_r=$(Ve,S,W,G),Un=Z(se(_e,Ie),K,E,X),nn=B(_r-Me),
Wn=B(ct(Un,rt)),xt=B(en(Un,rt)),Ot=Wn-xt;if(_e!=null){let pt=_e<0?J:Hn,Wt=_e<0?Hn:J;tn?(Ne>0&&kn[L]!=null&&le(hr.get(kn[L]),
nn,xt+At(Ne/2),fe,ct(0,Ot-Ne),pt,Wt),dn[L]!=null&&le(Pt.get(dn[L]),nn,xt+At(Ne/2),fe,ct(0,Ot-Ne),pt,Wt)):le(vr,nn,xt+At(
Ne/2),fe,ct(0,Ot-Ne),pt,Wt),de(v,k,L,nn-Ne/2,xt,fe+Ne,Ot)}}return Ne>0?ot.stroke=tn?hr:vr:tn||(ot._fill=F.width==0?F._fill:
F._stroke??F._fill,ot.width=0),ot.fill=tn?Pt:vr,ot})}function s0(e,t){let n=se(t?.alignGaps,0);return(r,o,l,a)=>mr(r,o,(c,d,m,g,_,x,v,k,N,A,F)=>{
[l,a]=fi(m,l,a);let w=c.pxRound,P=H=>w(x(H,g,A,k)),S=H=>w(v(H,_,F,N)),K,$,Z;g.ori==0?(K=gi,Z=io,$=zp):(K=vi,Z=so,$=Hp);let G=g.
dir*(g.ori==0?1:-1),X=P(d[G==1?l:a]),W=X,E=[],B=[];for(let H=G==1?l:a;H>=l&&H<=a;H+=G)if(m[H]!=null){let ke=d[H],le=P(ke);
E.push(W=le),B.push(S(m[H]))}let C={stroke:e(E,B,K,Z,$,w),fill:null,clip:null,band:null,gaps:null,flags:oo},q=C.stroke,[
U,re]=ka(r,o);if(c.fill!=null||U!=0){let H=C.fill=new Path2D(q),ft=c.fillTo(r,o,c.min,c.max,U),ke=S(ft);Z(H,W,ke),Z(H,X,
ke)}if(!c.spanGaps){let H=[];H.push(...Ma(d,m,l,a,G,P,n)),C.gaps=H=c.gaps(r,o,l,a,H),C.clip=hi(H,g.ori,k,N,A,F)}return re!=
0&&(C.band=re==2?[yn(r,o,l,a,q,-1),yn(r,o,l,a,q,1)]:yn(r,o,l,a,q,re)),C})}function a0(e){return s0(u0,e)}function u0(e,t,n,r,o,l){
let a=e.length;if(a<2)return null;let c=new Path2D;if(n(c,e[0],t[0]),a==2)r(c,e[1],t[1]);else{let d=Array(a),m=Array(a-1),
g=Array(a-1),_=Array(a-1);for(let x=0;x<a-1;x++)g[x]=t[x+1]-t[x],_[x]=e[x+1]-e[x],m[x]=g[x]/_[x];d[0]=m[0];for(let x=1;x<
a-1;x++)m[x]===0||m[x-1]===0||m[x-1]>0!=m[x]>0?d[x]=0:(d[x]=3*(_[x-1]+_[x])/((2*_[x]+_[x-1])/m[x-1]+(_[x]+2*_[x-1])/m[x]),
isFinite(d[x])||(d[x]=0));d[a-1]=m[a-2];for(let x=0;x<a-1;x++)o(c,e[x]+_[x]/3,t[x]+d[x]*_[x]/3,e[x+1]-_[x]/3,t[x+1]-d[x+
1]*_[x]/3,e[x+1],t[x+1])}return c}var fa=new Set;function lp(){for(let e of fa)e.syncRect(!0)}lo&&(pr(Wg,eo,lp),pr(Gg,eo,
lp,!0),pr(ai,eo,()=>{Ze.pxRatio=ce}));var c0=Gp(),f0=Up();function ip(e,t,n,r){return(r?[e[0],e[1]].concat(e.slice(2)):[
e[0]].concat(e.slice(1))).map((l,a)=>pa(l,a,t,n))}function p0(e,t){return e.map((n,r)=>r==0?{}:Re({},t,n))}function pa(e,t,n,r){
return Re({},t==0?n:r,e)}function Bp(e,t,n){return t==null?no:[t,n]}var d0=Bp;function m0(e,t,n){return t==null?no:ui(t,
n,va,!0)}function jp(e,t,n,r){return t==null?no:pi(t,n,e.scales[r].log,!1)}var h0=jp;function qp(e,t,n,r){return t==null?
no:ga(t,n,e.scales[r].log,!1)}var g0=qp;function v0(e,t,n,r,o){let l=ct(If(e),If(t)),a=t-e,c=Qt(o/r*a,n);do{let d=n[c],m=r*
d/a;if(m>=o&&l+(d<5?Vn.get(d):0)<=17)return[d,m]}while(++c<n.length);return[0,0]}function sp(e){let t,n;return e=e.replace(
/(\d+)px/,(r,o)=>(t=Ue((n=+o)*ce))+"px"),[e,t,n]}function _0(e){e.show&&[e.font,e.labelFont].forEach(t=>{let n=ve(t[2]*ce,
1);t[0]=t[0].replace(/[0-9.]+px/,n+"px"),t[1]=n})}function Ze(e,t,n){let r={mode:se(e.mode,1)},o=r.mode;function l(s,u,f,p){
let h=u.valToPct(s);return p+f*(u.dir==-1?1-h:h)}function a(s,u,f,p){let h=u.valToPct(s);return p+f*(u.dir==-1?h:1-h)}function c(s,u,f,p){
return u.ori==0?l(s,u,f,p):a(s,u,f,p)}r.valToPosH=l,r.valToPosV=a;let d=!1;r.status=0;let m=r.root=Vt(Mg);if(e.id!=null&&
(m.id=e.id),Et(m,e.class),e.title){let s=Vt(Ag,m);s.textContent=e.title}let g=Xt("canvas"),_=r.ctx=g.getContext("2d"),x=Vt(
Ng,m);pr("click",x,s=>{s.target===k&&(be!=Nr||Te!=Pr)&&Xe.click(r,s)},!0);let v=r.under=Vt(Pg,x);x.appendChild(g);let k=r.
over=Vt(Og,x);e=ro(e);let N=+se(e.pxAlign,1),A=rp(N);(e.plugins||[]).forEach(s=>{s.opts&&(e=s.opts(r,e)||e)});let F=e.ms||
.001,w=r.series=o==1?ip(e.series||[],Zf,tp,!1):p0(e.series||[null],ep),P=r.axes=ip(e.axes||[],Kf,Xf,!0),S=r.scales={},K=r.
bands=e.bands||[];K.forEach(s=>{s.fill=ne(s.fill||null),s.dir=se(s.dir,-1)});let $=o==2?w[1].facets[0].scale:w[0].scale,
Z={axes:Ed,series:yd},G=(e.drawOrder||["axes","series"]).map(s=>Z[s]);function X(s){let u=s.distr==3?f=>wn(f>0?f:s.clamp(
r,f,s.min,s.max,s.key)):s.distr==4?f=>Qs(f,s.asinh):s.distr==100?f=>s.fwd(f):f=>f;return f=>{let p=u(f),{_min:h,_max:b}=s,
y=b-h;return(p-h)/y}}function W(s){let u=S[s];if(u==null){let f=(e.scales||Zo)[s]||Zo;if(f.from!=null){W(f.from);let p=Re(
{},S[f.from],f,{key:s});p.valToPct=X(p),S[s]=p}else{u=S[s]=Re({},s==$?Lp:e0,f),u.key=s;let p=u.time,h=u.range,b=In(h);if((s!=
$||o==2&&!p)&&(b&&(h[0]==null||h[1]==null)&&(h={min:h[0]==null?Lf:{mode:1,hard:h[0],soft:h[0]},max:h[1]==null?Lf:{mode:1,
hard:h[1],soft:h[1]}},b=!1),!b&&mi(h))){let y=h;h=(M,T,O)=>T==null?no:ui(T,O,y)}u.range=ne(h||(p?d0:s==$?u.distr==3?h0:u.
distr==4?g0:Bp:u.distr==3?jp:u.distr==4?qp:m0)),u.auto=ne(b?!1:u.auto),u.clamp=ne(u.clamp||Qv),u._min=u._max=null,u.valToPct=
X(u)}}}W("x"),W("y"),o==1&&w.forEach(s=>{W(s.scale)}),P.forEach(s=>{W(s.scale)});for(let s in e.scales)W(s);let E=S[$],B=E.
distr,C,q;E.ori==0?(Et(m,Tg),C=l,q=a):(Et(m,Eg),C=a,q=l);let U={};for(let s in S){let u=S[s];(u.min!=null||u.max!=null)&&
(U[s]={min:u.min,max:u.max},u.min=u.max=null)}let re=e.tzDate||(s=>new Date(Ue(s/F))),H=e.fmtDate||xa,ft=F==1?Tv(re):Nv(
re),ke=jf(re,Bf(F==1?Mv:Av,H)),le=Yf(re,qf(Ov,H)),de=[],Q=r.legend=Re({},Dv,e.legend),V=r.cursor=Re({},zv,{drag:{y:o==2}},
e.cursor),Ie=Q.show,rt=V.show,Me=Q.markers;Q.idxs=de,Me.width=ne(Me.width),Me.dash=ne(Me.dash),Me.stroke=ne(Me.stroke),Me.
fill=ne(Me.fill);let fe,Ut,bt,Ne=[],tn=[],dn,Pt=!1,kn={};if(Q.live){let s=w[1]?w[1].values:null;Pt=s!=null,dn=Pt?s(r,1,0):
{_:0};for(let u in dn)kn[u]=ma}if(Ie)if(fe=Xt("table",Rg,m),bt=Xt("tbody",null,fe),Q.mount(r,fe),Pt){Ut=Xt("thead",null,
fe,bt);let s=Xt("tr",null,Ut);Xt("th",null,s);for(var hr in dn)Xt("th",yf,s).textContent=hr}else Et(fe,Vg),Q.live&&Et(fe,
Ig);let gr={show:!0},uo={show:!1};function Qo(s,u){if(u==0&&(Pt||!Q.live||o==2))return no;let f=[],p=Xt("tr",zg,bt,bt.childNodes[u]);
Et(p,s.class),s.show||Et(p,fr);let h=Xt("th",null,p);if(Me.show){let M=Vt(Hg,h);if(u>0){let T=Me.width(r,u);T&&(M.style.
border=T+"px "+Me.dash(r,u)+" "+Me.stroke(r,u)),M.style.background=Me.fill(r,u)}}let b=Vt(yf,h);s.label instanceof HTMLElement?
b.appendChild(s.label):b.textContent=s.label,u>0&&(Me.show||(b.style.color=s.width>0?Me.stroke(r,u):Me.fill(r,u)),ot("cl\
ick",h,M=>{if(V._lock)return;Bn(M);let T=w.indexOf(s);if((M.ctrlKey||M.metaKey)!=Q.isolate){let O=w.some((D,R)=>R>0&&R!=
T&&D.show);w.forEach((D,R)=>{R>0&&on(R,O?R==T?gr:uo:gr,!0,Ce.setSeries)})}else on(T,{show:!s.show},!0,Ce.setSeries)},!1),
xr&&ot(Tf,h,M=>{V._lock||(Bn(M),on(w.indexOf(s),Fr,!0,Ce.setSeries))},!1));for(var y in dn){let M=Xt("td",Ug,p);M.textContent=
"--",f.push(M)}return[p,f]}let zn=new Map;function ot(s,u,f,p=!0){let h=zn.get(u)||{},b=V.bind[s](r,u,f,p);b&&(pr(s,u,h[s]=
b),zn.set(u,h))}function vr(s,u,f){let p=zn.get(u)||{};for(let h in p)(s==null||h==s)&&(ia(h,u,p[h]),delete p[h]);s==null&&
zn.delete(u)}let mn=0,Hn=0,J=0,L=0,_e=0,Ve=0,_r=_e,Un=Ve,nn=J,Wn=L,xt=0,Ot=0,pt=0,Wt=0;r.bbox={};let Si=!1,el=!1,br=!1,Gn=!1,
tl=!1,Ft=!1;function ki(s,u,f){(f||s!=r.width||u!=r.height)&&Ca(s,u),Mr(!1),br=!0,el=!0,Tr()}function Ca(s,u){r.width=mn=
J=s,r.height=Hn=L=u,_e=Ve=0,hd(),gd();let f=r.bbox;xt=f.left=ur(_e*ce,.5),Ot=f.top=ur(Ve*ce,.5),pt=f.width=ur(J*ce,.5),Wt=
f.height=ur(L*ce,.5)}let pd=3;function dd(){let s=!1,u=0;for(;!s;){u++;let f=Md(u),p=Td(u);s=u==pd||f&&p,s||(Ca(r.width,
r.height),el=!0)}}function md({width:s,height:u}){ki(s,u)}r.setSize=md;function hd(){let s=!1,u=!1,f=!1,p=!1;P.forEach((h,b)=>{
if(h.show&&h._show){let{side:y,_size:M}=h,T=y%2,O=h.label!=null?h.labelSize:0,D=M+O;D>0&&(T?(J-=D,y==3?(_e+=D,p=!0):f=!0):
(L-=D,y==0?(Ve+=D,s=!0):u=!0))}}),jn[0]=s,jn[1]=f,jn[2]=u,jn[3]=p,J-=Mn[1]+Mn[3],_e+=Mn[3],L-=Mn[2]+Mn[0],Ve+=Mn[0]}function gd(){
let s=_e+J,u=Ve+L,f=_e,p=Ve;function h(b,y){switch(b){case 1:return s+=y,s-y;case 2:return u+=y,u-y;case 3:return f-=y,f+
y;case 0:return p-=y,p+y}}P.forEach((b,y)=>{if(b.show&&b._show){let M=b.side;b._pos=h(M,b._size),b.label!=null&&(b._lpos=
h(M,b.labelSize))}})}if(V.dataIdx==null){let s=V.hover,u=s.skip=new Set(s.skip??[]);u.add(void 0);let f=s.prox=ne(s.prox),
p=s.bias??=0;V.dataIdx=(h,b,y,M)=>{if(b==0)return y;let T=y,O=f(h,b,y,M)??ge,D=O>=0&&O<ge,R=E.ori==0?J:L,Y=V.left,ae=t[0],
ie=t[b];if(u.has(ie[y])){T=null;let ee=null,j=null,z;if(p==0||p==-1)for(z=y;ee==null&&z-- >0;)u.has(ie[z])||(ee=z);if(p==
0||p==1)for(z=y;j==null&&z++<ie.length;)u.has(ie[z])||(j=z);if(ee!=null||j!=null)if(D){let we=ee==null?-1/0:C(ae[ee],E,R,
0),Pe=j==null?1/0:C(ae[j],E,R,0),Ke=Y-we,me=Pe-Y;Ke<=me?Ke<=O&&(T=ee):me<=O&&(T=j)}else T=j==null?ee:ee==null?j:y-ee<=j-
y?ee:j}else D&&We(Y-C(ae[y],E,R,0))>O&&(T=null);return T}}let Bn=s=>{V.event=s};V.idxs=de,V._lock=!1;let tt=V.points;tt.
show=ne(tt.show),tt.size=ne(tt.size),tt.stroke=ne(tt.stroke),tt.width=ne(tt.width),tt.fill=ne(tt.fill);let rn=r.focus=Re(
{},e.focus||{alpha:.3},V.focus),xr=rn.prox>=0,wr=xr&&tt.one,Ct=[],yr=[],Sr=[];function Da(s,u){let f=tt.show(r,u);if(f instanceof
HTMLElement)return Et(f,$g),Et(f,s.class),pn(f,-10,-10,J,L),k.insertBefore(f,Ct[u]),f}function La(s,u){if(o==1||u>0){let f=o==
1&&S[s.scale].time,p=s.value;s.value=f?Hf(p)?Yf(re,qf(p,H)):p||le:p||Zv,s.label=s.label||(f?Uv:Hv)}if(wr||u>0){s.width=s.
width==null?1:s.width,s.paths=s.paths||c0||ev,s.fillTo=ne(s.fillTo||t0),s.pxAlign=+se(s.pxAlign,N),s.pxRound=rp(s.pxAlign),
s.stroke=ne(s.stroke||null),s.fill=ne(s.fill||null),s._stroke=s._fill=s._paths=s._focus=null;let f=Jv(ct(1,s.width),1),p=s.
points=Re({},{size:f,width:ct(1,f*.2),stroke:s.stroke,space:f*2,paths:f0,_stroke:null,_fill:null},s.points);p.show=ne(p.
show),p.filter=ne(p.filter),p.fill=ne(p.fill),p.stroke=ne(p.stroke),p.paths=ne(p.paths),p.pxAlign=s.pxAlign}if(Ie){let f=Qo(
s,u);Ne.splice(u,0,f[0]),tn.splice(u,0,f[1]),Q.values.push(null)}if(rt){de.splice(u,0,null);let f=null;wr?u==0&&(f=Da(s,
u)):u>0&&(f=Da(s,u)),Ct.splice(u,0,f),yr.splice(u,0,0),Sr.splice(u,0,0)}Ye("addSeries",u)}function vd(s,u){u=u??w.length,
s=o==1?pa(s,u,Zf,tp):pa(s,u,{},ep),w.splice(u,0,s),La(w[u],u)}r.addSeries=vd;function _d(s){if(w.splice(s,1),Ie){Q.values.
splice(s,1),tn.splice(s,1);let u=Ne.splice(s,1)[0];vr(null,u.firstChild),u.remove()}rt&&(de.splice(s,1),Ct.splice(s,1)[0].
remove(),yr.splice(s,1),Sr.splice(s,1)),Ye("delSeries",s)}r.delSeries=_d;let jn=[!1,!1,!1,!1];function bd(s,u){if(s._show=
s.show,s.show){let f=s.side%2,p=S[s.scale];p==null&&(s.scale=f?w[1].scale:$,p=S[s.scale]);let h=p.time;s.size=ne(s.size),
s.space=ne(s.space),s.rotate=ne(s.rotate),In(s.incrs)&&s.incrs.forEach(y=>{!Vn.has(y)&&Vn.set(y,gp(y))}),s.incrs=ne(s.incrs||
(p.distr==2?yv:h?F==1?kv:Ev:cr)),s.splits=ne(s.splits||(h&&p.distr==1?ft:p.distr==3?aa:p.distr==4?Bv:Gv)),s.stroke=ne(s.
stroke),s.grid.stroke=ne(s.grid.stroke),s.ticks.stroke=ne(s.ticks.stroke),s.border.stroke=ne(s.border.stroke);let b=s.values;
s.values=In(b)&&!In(b[0])?ne(b):h?In(b)?jf(re,Bf(b,H)):Hf(b)?Pv(re,b):b||ke:b||Wv,s.filter=ne(s.filter||(p.distr>=3&&p.log==
10?Yv:p.distr==3&&p.log==2?Kv:mp)),s.font=sp(s.font),s.labelFont=sp(s.labelFont),s._size=s.size(r,null,u,0),s._space=s._rotate=
s._incrs=s._found=s._splits=s._values=null,s._size>0&&(jn[u]=!0,s._el=Vt(Fg,x))}}function co(s,u,f,p){let[h,b,y,M]=f,T=u%
2,O=0;return T==0&&(M||b)&&(O=u==0&&!h||u==2&&!y?Ue(Kf.size/3):0),T==1&&(h||y)&&(O=u==1&&!b||u==3&&!M?Ue(Xf.size/2):0),O}
let $a=r.padding=(e.padding||[co,co,co,co]).map(s=>ne(se(s,co))),Mn=r._padding=$a.map((s,u)=>s(r,u,jn,0)),Je,Ge=null,Be=null,
nl=o==1?w[0].idxs:null,Gt=null,fo=!1;function Ra(s,u){if(t=s??[],r.data=r._data=t,o==2){Je=0;for(let f=1;f<w.length;f++)
Je+=t[f][0].length}else{t.length==0&&(r.data=r._data=t=[[]]),Gt=t[0],Je=Gt.length;let f=t;if(B==2){f=t.slice();let p=f[0]=
Array(Je);for(let h=0;h<Je;h++)p[h]=h}r._data=t=f}if(Mr(!0),Ye("setData"),B==2&&(br=!0),u!==!1){let f=E;f.auto(r,fo)?Mi():
En($,f.min,f.max),Gn=Gn||V.left>=0,Ft=!0,Tr()}}r.setData=Ra;function Mi(){fo=!0;let s,u;o==1&&(Je>0?(Ge=nl[0]=0,Be=nl[1]=
Je-1,s=t[0][Ge],u=t[0][Be],B==2?(s=Ge,u=Be):s==u&&(B==3?[s,u]=pi(s,s,E.log,!1):B==4?[s,u]=ga(s,s,E.log,!1):E.time?u=s+Ue(
86400/F):[s,u]=ui(s,u,va,!0))):(Ge=nl[0]=s=null,Be=nl[1]=u=null)),En($,s,u)}let rl,kr,Ti,Ei,Ai,Ni,Pi,Oi,Fi,dt;function Ia(s,u,f,p,h,b){
s??=kf,f??=ba,p??="butt",h??=kf,b??="round",s!=rl&&(_.strokeStyle=rl=s),h!=kr&&(_.fillStyle=kr=h),u!=Ti&&(_.lineWidth=Ti=
u),b!=Ai&&(_.lineJoin=Ai=b),p!=Ni&&(_.lineCap=Ni=p),f!=Ei&&_.setLineDash(Ei=f)}function Va(s,u,f,p){u!=kr&&(_.fillStyle=
kr=u),s!=Pi&&(_.font=Pi=s),f!=Oi&&(_.textAlign=Oi=f),p!=Fi&&(_.textBaseline=Fi=p)}function Ci(s,u,f,p,h=0){if(p.length>0&&
s.auto(r,fo)&&(u==null||u.min==null)){let b=se(Ge,0),y=se(Be,p.length-1),M=f.min==null?Yg(p,b,y,h,s.distr==3):[f.min,f.max];
s.min=en(s.min,f.min=M[0]),s.max=ct(s.max,f.max=M[1])}}let za={min:null,max:null};function xd(){for(let p in S){let h=S[p];
U[p]==null&&(h.min==null||U[$]!=null&&h.auto(r,fo))&&(U[p]=za)}for(let p in S){let h=S[p];U[p]==null&&h.from!=null&&U[h.
from]!=null&&(U[p]=za)}U[$]!=null&&Mr(!0);let s={};for(let p in U){let h=U[p];if(h!=null){let b=s[p]=ro(S[p],rv);if(h.min!=
null)Re(b,h);else if(p!=$||o==2)if(Je==0&&b.from==null){let y=b.range(r,null,null,p);b.min=y[0],b.max=y[1]}else b.min=ge,
b.max=-ge}}if(Je>0){w.forEach((p,h)=>{if(o==1){let b=p.scale,y=U[b];if(y==null)return;let M=s[b];if(h==0){let T=M.range(
r,M.min,M.max,b);M.min=T[0],M.max=T[1],Ge=Qt(M.min,t[0]),Be=Qt(M.max,t[0]),Be-Ge>1&&(t[0][Ge]<M.min&&Ge++,t[0][Be]>M.max&&
Be--),p.min=Gt[Ge],p.max=Gt[Be]}else p.show&&p.auto&&Ci(M,y,p,t[h],p.sorted);p.idxs[0]=Ge,p.idxs[1]=Be}else if(h>0&&p.show&&
p.auto){let[b,y]=p.facets,M=b.scale,T=y.scale,[O,D]=t[h],R=s[M],Y=s[T];R!=null&&Ci(R,U[M],b,O,b.sorted),Y!=null&&Ci(Y,U[T],
y,D,y.sorted),p.min=y.min,p.max=y.max}});for(let p in s){let h=s[p],b=U[p];if(h.from==null&&(b==null||b.min==null)){let y=h.
range(r,h.min==ge?null:h.min,h.max==-ge?null:h.max,p);h.min=y[0],h.max=y[1]}}}for(let p in s){let h=s[p];if(h.from!=null){
let b=s[h.from];if(b.min==null)h.min=h.max=null;else{let y=h.range(r,b.min,b.max,p);h.min=y[0],h.max=y[1]}}}let u={},f=!1;
for(let p in s){let h=s[p],b=S[p];if(b.min!=h.min||b.max!=h.max){b.min=h.min,b.max=h.max;let y=b.distr;b._min=y==3?wn(b.
min):y==4?Qs(b.min,b.asinh):y==100?b.fwd(b.min):b.min,b._max=y==3?wn(b.max):y==4?Qs(b.max,b.asinh):y==100?b.fwd(b.max):b.
max,u[p]=f=!0}}if(f){w.forEach((p,h)=>{o==2?h>0&&u.y&&(p._paths=null):u[p.scale]&&(p._paths=null)});for(let p in u)br=!0,
Ye("setScale",p);rt&&V.left>=0&&(Gn=Ft=!0)}for(let p in U)U[p]=null}function wd(s){let u=sa(Ge-1,0,Je-1),f=sa(Be+1,0,Je-
1);for(;s[u]==null&&u>0;)u--;for(;s[f]==null&&f<Je-1;)f++;return[u,f]}function yd(){if(Je>0){let s=w.some(u=>u._focus)&&
dt!=rn.alpha;s&&(_.globalAlpha=dt=rn.alpha),w.forEach((u,f)=>{if(f>0&&u.show&&(Ha(f,!1),Ha(f,!0),u._paths==null)){let p=dt;
dt!=u.alpha&&(_.globalAlpha=dt=u.alpha);let h=o==2?[0,t[f][0].length-1]:wd(t[f]);u._paths=u.paths(r,f,h[0],h[1]),dt!=p&&
(_.globalAlpha=dt=p)}}),w.forEach((u,f)=>{if(f>0&&u.show){let p=dt;dt!=u.alpha&&(_.globalAlpha=dt=u.alpha),u._paths!=null&&
Ua(f,!1);{let h=u._paths!=null?u._paths.gaps:null,b=u.points.show(r,f,Ge,Be,h),y=u.points.filter(r,f,b,h);(b||y)&&(u.points.
_paths=u.points.paths(r,f,Ge,Be,y),Ua(f,!0))}dt!=p&&(_.globalAlpha=dt=p),Ye("drawSeries",f)}}),s&&(_.globalAlpha=dt=1)}}
function Ha(s,u){let f=u?w[s].points:w[s];f._stroke=f.stroke(r,s),f._fill=f.fill(r,s)}function Ua(s,u){let f=u?w[s].points:
w[s],{stroke:p,fill:h,clip:b,flags:y,_stroke:M=f._stroke,_fill:T=f._fill,_width:O=f.width}=f._paths;O=ve(O*ce,3);let D=null,
R=O%2/2;u&&T==null&&(T=O>0?"#fff":M);let Y=f.pxAlign==1&&R>0;if(Y&&_.translate(R,R),!u){let ae=xt-O/2,ie=Ot-O/2,ee=pt+O,
j=Wt+O;D=new Path2D,D.rect(ae,ie,ee,j)}u?Di(M,O,f.dash,f.cap,T,p,h,y,b):Sd(s,M,O,f.dash,f.cap,T,p,h,y,D,b),Y&&_.translate(
-R,-R)}function Sd(s,u,f,p,h,b,y,M,T,O,D){let R=!1;T!=0&&K.forEach((Y,ae)=>{if(Y.series[0]==s){let ie=w[Y.series[1]],ee=t[Y.
series[1]],j=(ie._paths||Zo).band;In(j)&&(j=Y.dir==1?j[0]:j[1]);let z,we=null;ie.show&&j&&Zg(ee,Ge,Be)?(we=Y.fill(r,ae)||
b,z=ie._paths.clip):j=null,Di(u,f,p,h,we,y,M,T,O,D,z,j),R=!0}}),R||Di(u,f,p,h,b,y,M,T,O,D)}let Wa=oo|ca;function Di(s,u,f,p,h,b,y,M,T,O,D,R){
Ia(s,u,f,p,h),(T||O||R)&&(_.save(),T&&_.clip(T),O&&_.clip(O)),R?(M&Wa)==Wa?(_.clip(R),D&&_.clip(D),ll(h,y),ol(s,b,u)):M&
ca?(ll(h,y),_.clip(R),ol(s,b,u)):M&oo&&(_.save(),_.clip(R),D&&_.clip(D),ll(h,y),_.restore(),ol(s,b,u)):(ll(h,y),ol(s,b,u)),
(T||O||R)&&_.restore()}function ol(s,u,f){f>0&&(u instanceof Map?u.forEach((p,h)=>{_.strokeStyle=rl=h,_.stroke(p)}):u!=null&&
s&&_.stroke(u))}function ll(s,u){u instanceof Map?u.forEach((f,p)=>{_.fillStyle=kr=p,_.fill(f)}):u!=null&&s&&_.fill(u)}function kd(s,u,f,p){
let h=P[s],b;if(p<=0)b=[0,0];else{let y=h._space=h.space(r,s,u,f,p),M=h._incrs=h.incrs(r,s,u,f,p,y);b=v0(u,f,M,p,y)}return h.
_found=b}function Li(s,u,f,p,h,b,y,M,T,O){let D=y%2/2;N==1&&_.translate(D,D),Ia(M,y,T,O,M),_.beginPath();let R,Y,ae,ie,ee=h+
(p==0||p==3?-b:b);f==0?(Y=h,ie=ee):(R=h,ae=ee);for(let j=0;j<s.length;j++)u[j]!=null&&(f==0?R=ae=s[j]:Y=ie=s[j],_.moveTo(
R,Y),_.lineTo(ae,ie));_.stroke(),N==1&&_.translate(-D,-D)}function Md(s){let u=!0;return P.forEach((f,p)=>{if(!f.show)return;
let h=S[f.scale];if(h.min==null){f._show&&(u=!1,f._show=!1,Mr(!1));return}else f._show||(u=!1,f._show=!0,Mr(!1));let b=f.
side,y=b%2,{min:M,max:T}=h,[O,D]=kd(p,M,T,y==0?J:L);if(D==0)return;let R=h.distr==2,Y=f._splits=f.splits(r,p,M,T,O,D,R),
ae=h.distr==2?Y.map(z=>Gt[z]):Y,ie=h.distr==2?Gt[Y[1]]-Gt[Y[0]]:O,ee=f._values=f.values(r,f.filter(r,ae,p,D,ie),p,D,ie);
f._rotate=b==2?f.rotate(r,ee,p,D):0;let j=f._size;f._size=zt(f.size(r,ee,p,s)),j!=null&&f._size!=j&&(u=!1)}),u}function Td(s){
let u=!0;return $a.forEach((f,p)=>{let h=f(r,p,jn,s);h!=Mn[p]&&(u=!1),Mn[p]=h}),u}function Ed(){for(let s=0;s<P.length;s++){
let u=P[s];if(!u.show||!u._show)continue;let f=u.side,p=f%2,h,b,y=u.stroke(r,s),M=f==0||f==3?-1:1,[T,O]=u._found;if(u.label!=
null){let it=u.labelGap*M,St=Ue((u._lpos+it)*ce);Va(u.labelFont[0],y,"center",f==2?"top":Sf),_.save(),p==1?(h=b=0,_.translate(
St,Ue(Ot+Wt/2)),_.rotate((f==3?-si:si)/2)):(h=Ue(xt+pt/2),b=St);let Kn=pp(u.label)?u.label(r,s,T,O):u.label;_.fillText(Kn,
h,b),_.restore()}if(O==0)continue;let D=S[u.scale],R=p==0?pt:Wt,Y=p==0?xt:Ot,ae=u._splits,ie=D.distr==2?ae.map(it=>Gt[it]):
ae,ee=D.distr==2?Gt[ae[1]]-Gt[ae[0]]:T,j=u.ticks,z=u.border,we=j.show?j.size:0,Pe=Ue(we*ce),Ke=Ue((u.alignTo==2?u._size-
we-u.gap:u.gap)*ce),me=u._rotate*-si/180,Oe=A(u._pos*ce),wt=(Pe+Ke)*M,lt=Oe+wt;b=p==0?lt:0,h=p==1?lt:0;let Dt=u.font[0],
Bt=u.align==1?Xr:u.align==2?Zs:me>0?Xr:me<0?Zs:p==0?"center":f==3?Zs:Xr,sn=me||p==1?"middle":f==2?"top":Sf;Va(Dt,y,Bt,sn);
let yt=u.font[1]*u.lineGap,Lt=ae.map(it=>A(c(it,D,R,Y))),jt=u._values;for(let it=0;it<jt.length;it++){let St=jt[it];if(St!=
null){p==0?h=Lt[it]:b=Lt[it],St=""+St;let Kn=St.indexOf(`
`)==-1?[St]:St.split(/\n/gm);for(let st=0;st<Kn.length;st++){let au=Kn[st];me?(_.save(),_.translate(h,b+st*yt),_.rotate(
me),_.fillText(au,0,0),_.restore()):_.fillText(au,h,b+st*yt)}}}j.show&&Li(Lt,j.filter(r,ie,s,O,ee),p,f,Oe,Pe,ve(j.width*
ce,3),j.stroke(r,s),j.dash,j.cap);let an=u.grid;an.show&&Li(Lt,an.filter(r,ie,s,O,ee),p,p==0?2:1,p==0?Ot:xt,p==0?Wt:pt,ve(
an.width*ce,3),an.stroke(r,s),an.dash,an.cap),z.show&&Li([Oe],[1],p==0?1:0,p==0?1:2,p==1?Ot:xt,p==1?Wt:pt,ve(z.width*ce,
3),z.stroke(r,s),z.dash,z.cap)}Ye("drawAxes")}function Mr(s){w.forEach((u,f)=>{f>0&&(u._paths=null,s&&(o==1?(u.min=null,
u.max=null):u.facets.forEach(p=>{p.min=null,p.max=null})))})}let il=!1,$i=!1,po=[];function Ad(){$i=!1;for(let s=0;s<po.
length;s++)Ye(...po[s]);po.length=0}function Tr(){il||(cv(Ga),il=!0)}function Nd(s,u=!1){il=!0,$i=u,s(r),Ga(),u&&po.length>
0&&queueMicrotask(Ad)}r.batch=Nd;function Ga(){if(Si&&(xd(),Si=!1),br&&(dd(),br=!1),el){if(Se(v,Xr,_e),Se(v,"top",Ve),Se(
v,jo,J),Se(v,qo,L),Se(k,Xr,_e),Se(k,"top",Ve),Se(k,jo,J),Se(k,qo,L),Se(x,jo,mn),Se(x,qo,Hn),g.width=Ue(mn*ce),g.height=Ue(
Hn*ce),P.forEach(({_el:s,_show:u,_size:f,_pos:p,side:h})=>{if(s!=null)if(u){let b=h===3||h===0?f:0,y=h%2==1;Se(s,y?"left":
"top",p-b),Se(s,y?"width":"height",f),Se(s,y?"top":"left",y?Ve:_e),Se(s,y?"height":"width",y?L:J),la(s,fr)}else Et(s,fr)}),
rl=kr=Ti=Ai=Ni=Pi=Oi=Fi=Ei=null,dt=1,go(!0),_e!=_r||Ve!=Un||J!=nn||L!=Wn){Mr(!1);let s=J/nn,u=L/Wn;if(rt&&!Gn&&V.left>=0){
V.left*=s,V.top*=u,Er&&pn(Er,Ue(V.left),0,J,L),Ar&&pn(Ar,0,Ue(V.top),J,L);for(let f=0;f<Ct.length;f++){let p=Ct[f];p!=null&&
(yr[f]*=s,Sr[f]*=u,pn(p,zt(yr[f]),zt(Sr[f]),J,L))}}if(xe.show&&!tl&&xe.left>=0&&xe.width>0){xe.left*=s,xe.width*=s,xe.top*=
u,xe.height*=u;for(let f in Ui)Se(Or,f,xe[f])}_r=_e,Un=Ve,nn=J,Wn=L}Ye("setSize"),el=!1}mn>0&&Hn>0&&(_.clearRect(0,0,g.width,
g.height),Ye("drawClear"),G.forEach(s=>s()),Ye("draw")),xe.show&&tl&&(sl(xe),tl=!1),rt&&Gn&&(Yn(null,!0,!1),Gn=!1),Q.show&&
Q.live&&Ft&&(zi(),Ft=!1),d||(d=!0,r.status=1,Ye("ready")),fo=!1,il=!1}r.redraw=(s,u)=>{br=u||!1,s!==!1?En($,E.min,E.max):
Tr()};function Ri(s,u){let f=S[s];if(f.from==null){if(Je==0){let p=f.range(r,u.min,u.max,s);u.min=p[0],u.max=p[1]}if(u.min>
u.max){let p=u.min;u.min=u.max,u.max=p}if(Je>1&&u.min!=null&&u.max!=null&&u.max-u.min<1e-16)return;s==$&&f.distr==2&&Je>
0&&(u.min=Qt(u.min,t[0]),u.max=Qt(u.max,t[0]),u.min==u.max&&u.max++),U[s]=u,Si=!0,Tr()}}r.setScale=Ri;let Ii,Vi,Er,Ar,Ba,
ja,Nr,Pr,qa,Ya,be,Te,Tn=!1,Xe=V.drag,je=Xe.x,qe=Xe.y;rt&&(V.x&&(Ii=Vt(Dg,k)),V.y&&(Vi=Vt(Lg,k)),E.ori==0?(Er=Ii,Ar=Vi):(Er=
Vi,Ar=Ii),be=V.left,Te=V.top);let xe=r.select=Re({show:!0,over:!0,left:0,width:0,top:0,height:0},e.select),Or=xe.show?Vt(
Cg,xe.over?k:v):null;function sl(s,u){if(xe.show){for(let f in s)xe[f]=s[f],f in Ui&&Se(Or,f,s[f]);u!==!1&&Ye("setSelect")}}
r.setSelect=sl;function Pd(s){if(w[s].show)Ie&&la(Ne[s],fr);else if(Ie&&Et(Ne[s],fr),rt){let f=wr?Ct[0]:Ct[s];f!=null&&pn(
f,-10,-10,J,L)}}function En(s,u,f){Ri(s,{min:u,max:f})}function on(s,u,f,p){u.focus!=null&&Ld(s),u.show!=null&&w.forEach(
(h,b)=>{b>0&&(s==b||s==null)&&(h.show=u.show,Pd(b),o==2?(En(h.facets[0].scale,null,null),En(h.facets[1].scale,null,null)):
En(h.scale,null,null),Tr())}),f!==!1&&Ye("setSeries",s,u),p&&vo("setSeries",r,s,u)}r.setSeries=on;function Od(s,u){Re(K[s],
u)}function Fd(s,u){s.fill=ne(s.fill||null),s.dir=se(s.dir,-1),u=u??K.length,K.splice(u,0,s)}function Cd(s){s==null?K.length=
0:K.splice(s,1)}r.addBand=Fd,r.setBand=Od,r.delBand=Cd;function Dd(s,u){w[s].alpha=u,rt&&Ct[s]!=null&&(Ct[s].style.opacity=
u),Ie&&Ne[s]&&(Ne[s].style.opacity=u)}let hn,An,qn,Fr={focus:!0};function Ld(s){if(s!=qn){let u=s==null,f=rn.alpha!=1;w.
forEach((p,h)=>{if(o==1||h>0){let b=u||h==0||h==s;p._focus=u?null:b,f&&Dd(h,b?1:rn.alpha)}}),qn=s,f&&Tr()}}Ie&&xr&&ot(Ef,
fe,s=>{V._lock||(Bn(s),qn!=null&&on(null,Fr,!0,Ce.setSeries))});function ln(s,u,f){let p=S[u];f&&(s=s/ce-(p.ori==1?Ve:_e));
let h=J;p.ori==1&&(h=L,s=h-s),p.dir==-1&&(s=h-s);let b=p._min,y=p._max,M=s/h,T=b+(y-b)*M,O=p.distr;return O==3?to(10,T):
O==4?Xg(T,p.asinh):O==100?p.bwd(T):T}function $d(s,u){let f=ln(s,$,u);return Qt(f,t[0],Ge,Be)}r.valToIdx=s=>Qt(s,t[0]),r.
posToIdx=$d,r.posToVal=ln,r.valToPos=(s,u,f)=>S[u].ori==0?l(s,S[u],f?pt:J,f?xt:0):a(s,S[u],f?Wt:L,f?Ot:0),r.setCursor=(s,u,f)=>{
be=s.left,Te=s.top,Yn(null,u,f)};function Ka(s,u){Se(Or,Xr,xe.left=s),Se(Or,jo,xe.width=u)}function Za(s,u){Se(Or,"top",
xe.top=s),Se(Or,qo,xe.height=u)}let mo=E.ori==0?Ka:Za,ho=E.ori==1?Ka:Za;function Rd(){if(Ie&&Q.live)for(let s=o==2?1:0;s<
w.length;s++){if(s==0&&Pt)continue;let u=Q.values[s],f=0;for(let p in u)tn[s][f++].firstChild.nodeValue=u[p]}}function zi(s,u){
if(s!=null&&(s.idxs?s.idxs.forEach((f,p)=>{de[p]=f}):nv(s.idx)||de.fill(s.idx),Q.idx=de[0]),Ie&&Q.live){for(let f=0;f<w.
length;f++)(f>0||o==1&&!Pt)&&Id(f,de[f]);Rd()}Ft=!1,u!==!1&&Ye("setLegend")}r.setLegend=zi;function Id(s,u){let f=w[s],p=s==
0&&B==2?Gt:t[s],h;Pt?h=f.values(r,s,u)??kn:(h=f.value(r,u==null?null:p[u],s,u),h=h==null?kn:{_:h}),Q.values[s]=h}function Yn(s,u,f){
qa=be,Ya=Te,[be,Te]=V.move(r,be,Te),V.left=be,V.top=Te,rt&&(Er&&pn(Er,Ue(be),0,J,L),Ar&&pn(Ar,0,Ue(Te),J,L));let p,h=Ge>
Be;hn=ge,An=null;let b=E.ori==0?J:L,y=E.ori==1?J:L;if(be<0||Je==0||h){p=V.idx=null;for(let M=0;M<w.length;M++){let T=Ct[M];
T!=null&&pn(T,-10,-10,J,L)}xr&&on(null,Fr,!0,s==null&&Ce.setSeries),Q.live&&(de.fill(p),Ft=!0)}else{let M,T,O;o==1&&(M=E.
ori==0?be:Te,T=ln(M,$),p=V.idx=Qt(T,t[0],Ge,Be),O=C(t[0][p],E,b,0));let D=-10,R=-10,Y=0,ae=0,ie=!0,ee="",j="";for(let z=o==
2?1:0;z<w.length;z++){let we=w[z],Pe=de[z],Ke=Pe==null?null:o==1?t[z][Pe]:t[z][1][Pe],me=V.dataIdx(r,z,p,T),Oe=me==null?
null:o==1?t[z][me]:t[z][1][me];if(Ft=Ft||Oe!=Ke||me!=Pe,de[z]=me,z>0&&we.show){let wt=me==null?-10:me==p?O:C(o==1?t[0][me]:
t[z][0][me],E,b,0),lt=Oe==null?-10:q(Oe,o==1?S[we.scale]:S[we.facets[1].scale],y,0);if(xr&&Oe!=null){let Dt=E.ori==1?be:
Te,Bt=We(rn.dist(r,z,me,lt,Dt));if(Bt<hn){let sn=rn.bias;if(sn!=0){let yt=ln(Dt,we.scale),Lt=Oe>=0?1:-1,jt=yt>=0?1:-1;jt==
Lt&&(jt==1?sn==1?Oe>=yt:Oe<=yt:sn==1?Oe<=yt:Oe>=yt)&&(hn=Bt,An=z)}else hn=Bt,An=z}}if(Ft||wr){let Dt,Bt;E.ori==0?(Dt=wt,
Bt=lt):(Dt=lt,Bt=wt);let sn,yt,Lt,jt,an,it,St=!0,Kn=tt.bbox;if(Kn!=null){St=!1;let st=Kn(r,z);Lt=st.left,jt=st.top,sn=st.
width,yt=st.height}else Lt=Dt,jt=Bt,sn=yt=tt.size(r,z);if(it=tt.fill(r,z),an=tt.stroke(r,z),wr)z==An&&hn<=rn.prox&&(D=Lt,
R=jt,Y=sn,ae=yt,ie=St,ee=it,j=an);else{let st=Ct[z];st!=null&&(yr[z]=Lt,Sr[z]=jt,Df(st,sn,yt,St),Ff(st,it,an),pn(st,zt(Lt),
zt(jt),J,L))}}}}if(wr){let z=rn.prox,we=qn==null?hn<=z:hn>z||An!=qn;if(Ft||we){let Pe=Ct[0];Pe!=null&&(yr[0]=D,Sr[0]=R,Df(
Pe,Y,ae,ie),Ff(Pe,ee,j),pn(Pe,zt(D),zt(R),J,L))}}}if(xe.show&&Tn)if(s!=null){let[M,T]=Ce.scales,[O,D]=Ce.match,[R,Y]=s.cursor.
sync.scales,ae=s.cursor.drag;if(je=ae._x,qe=ae._y,je||qe){let{left:ie,top:ee,width:j,height:z}=s.select,we=s.scales[R].ori,
Pe=s.posToVal,Ke,me,Oe,wt,lt,Dt=M!=null&&O(M,R),Bt=T!=null&&D(T,Y);Dt&&je?(we==0?(Ke=ie,me=j):(Ke=ee,me=z),Oe=S[M],wt=C(
Pe(Ke,R),Oe,b,0),lt=C(Pe(Ke+me,R),Oe,b,0),mo(en(wt,lt),We(lt-wt))):mo(0,b),Bt&&qe?(we==1?(Ke=ie,me=j):(Ke=ee,me=z),Oe=S[T],
wt=q(Pe(Ke,Y),Oe,y,0),lt=q(Pe(Ke+me,Y),Oe,y,0),ho(en(wt,lt),We(lt-wt))):ho(0,y)}else Wi()}else{let M=We(qa-Ba),T=We(Ya-ja);
if(E.ori==1){let Y=M;M=T,T=Y}je=Xe.x&&M>=Xe.dist,qe=Xe.y&&T>=Xe.dist;let O=Xe.uni;O!=null?je&&qe&&(je=M>=O,qe=T>=O,!je&&
!qe&&(T>M?qe=!0:je=!0)):Xe.x&&Xe.y&&(je||qe)&&(je=qe=!0);let D,R;je&&(E.ori==0?(D=Nr,R=be):(D=Pr,R=Te),mo(en(D,R),We(R-D)),
qe||ho(0,y)),qe&&(E.ori==1?(D=Nr,R=be):(D=Pr,R=Te),ho(en(D,R),We(R-D)),je||mo(0,b)),!je&&!qe&&(mo(0,0),ho(0,0))}if(Xe._x=
je,Xe._y=qe,s==null){if(f){if(su!=null){let[M,T]=Ce.scales;Ce.values[0]=M!=null?ln(E.ori==0?be:Te,M):null,Ce.values[1]=T!=
null?ln(E.ori==1?be:Te,T):null}vo(Js,r,be,Te,J,L,p)}if(xr){let M=f&&Ce.setSeries,T=rn.prox;qn==null?hn<=T&&on(An,Fr,!0,M):
hn>T?on(null,Fr,!0,M):An!=qn&&on(An,Fr,!0,M)}}Ft&&(Q.idx=p,zi()),u!==!1&&Ye("setCursor")}let Nn=null;Object.defineProperty(
r,"rect",{get(){return Nn==null&&go(!1),Nn}});function go(s=!1){s?Nn=null:(Nn=k.getBoundingClientRect(),Ye("syncRect",Nn))}
function Ja(s,u,f,p,h,b,y){V._lock||Tn&&s!=null&&s.movementX==0&&s.movementY==0||(Hi(s,u,f,p,h,b,y,!1,s!=null),s!=null?Yn(
null,!0,!0):Yn(u,!0,!1))}function Hi(s,u,f,p,h,b,y,M,T){if(Nn==null&&go(!1),Bn(s),s!=null)f=s.clientX-Nn.left,p=s.clientY-
Nn.top;else{if(f<0||p<0){be=-10,Te=-10;return}let[O,D]=Ce.scales,R=u.cursor.sync,[Y,ae]=R.values,[ie,ee]=R.scales,[j,z]=Ce.
match,we=u.axes[0].side%2==1,Pe=E.ori==0?J:L,Ke=E.ori==1?J:L,me=we?b:h,Oe=we?h:b,wt=we?p:f,lt=we?f:p;if(ie!=null?f=j(O,ie)?
c(Y,S[O],Pe,0):-10:f=Pe*(wt/me),ee!=null?p=z(D,ee)?c(ae,S[D],Ke,0):-10:p=Ke*(lt/Oe),E.ori==1){let Dt=f;f=p,p=Dt}}T&&(u==
null||u.cursor.event.type==Js)&&((f<=1||f>=J-1)&&(f=ur(f,J)),(p<=1||p>=L-1)&&(p=ur(p,L))),M?(Ba=f,ja=p,[Nr,Pr]=V.move(r,
f,p)):(be=f,Te=p)}let Ui={width:0,height:0,left:0,top:0};function Wi(){sl(Ui,!1)}let Xa,Qa,eu,tu;function nu(s,u,f,p,h,b,y){
Tn=!0,je=qe=Xe._x=Xe._y=!1,Hi(s,u,f,p,h,b,y,!0,!1),s!=null&&(ot(Xs,ra,ru,!1),vo(Mf,r,Nr,Pr,J,L,null));let{left:M,top:T,width:O,
height:D}=xe;Xa=M,Qa=T,eu=O,tu=D}function ru(s,u,f,p,h,b,y){Tn=Xe._x=Xe._y=!1,Hi(s,u,f,p,h,b,y,!1,!0);let{left:M,top:T,width:O,
height:D}=xe,R=O>0||D>0,Y=Xa!=M||Qa!=T||eu!=O||tu!=D;if(R&&Y&&sl(xe),Xe.setScale&&R&&Y){let ae=M,ie=O,ee=T,j=D;if(E.ori==
1&&(ae=T,ie=D,ee=M,j=O),je&&En($,ln(ae,$),ln(ae+ie,$)),qe)for(let z in S){let we=S[z];z!=$&&we.from==null&&we.min!=ge&&En(
z,ln(ee+j,z),ln(ee,z))}Wi()}else V.lock&&(V._lock=!V._lock,Yn(u,!0,s!=null));s!=null&&(vr(Xs,ra),vo(Xs,r,be,Te,J,L,null))}
function Vd(s,u,f,p,h,b,y){if(V._lock)return;Bn(s);let M=Tn;if(Tn){let T=!0,O=!0,D=10,R,Y;E.ori==0?(R=je,Y=qe):(R=qe,Y=je),
R&&Y&&(T=be<=D||be>=J-D,O=Te<=D||Te>=L-D),R&&T&&(be=be<Nr?0:J),Y&&O&&(Te=Te<Pr?0:L),Yn(null,!0,!0),Tn=!1}be=-10,Te=-10,de.
fill(null),Yn(null,!0,!0),M&&(Tn=M)}function ou(s,u,f,p,h,b,y){V._lock||(Bn(s),Mi(),Wi(),s!=null&&vo(Af,r,be,Te,J,L,null))}
function lu(){P.forEach(_0),ki(r.width,r.height,!0)}pr(ai,eo,lu);let Cr={};Cr.mousedown=nu,Cr.mousemove=Ja,Cr.mouseup=ru,
Cr.dblclick=ou,Cr.setSeries=(s,u,f,p)=>{let h=Ce.match[2];f=h(r,u,f),f!=-1&&on(f,p,!0,!1)},rt&&(ot(Mf,k,nu),ot(Js,k,Ja),
ot(Tf,k,s=>{Bn(s),go(!1)}),ot(Ef,k,Vd),ot(Af,k,ou),fa.add(r),r.syncRect=go);let al=r.hooks=e.hooks||{};function Ye(s,u,f){
$i?po.push([s,u,f]):s in al&&al[s].forEach(p=>{p.call(null,r,u,f)})}(e.plugins||[]).forEach(s=>{for(let u in s.hooks)al[u]=
(al[u]||[]).concat(s.hooks[u])});let iu=(s,u,f)=>f,Ce=Re({key:null,setSeries:!1,filters:{pub:Vf,sub:Vf},scales:[$,w[1]?w[1].
scale:null],match:[zf,zf,iu],values:[null,null]},V.sync);Ce.match.length==2&&Ce.match.push(iu),V.sync=Ce;let su=Ce.key,Gi=$p(
su);function vo(s,u,f,p,h,b,y){Ce.filters.pub(s,u,f,p,h,b,y)&&Gi.pub(s,u,f,p,h,b,y)}Gi.sub(r);function zd(s,u,f,p,h,b,y){
Ce.filters.sub(s,u,f,p,h,b,y)&&Cr[s](null,u,f,p,h,b,y)}r.pub=zd;function Hd(){Gi.unsub(r),fa.delete(r),zn.clear(),ia(ai,
eo,lu),m.remove(),fe?.remove(),Ye("destroy")}r.destroy=Hd;function Bi(){Ye("init",e,t),Ra(t||e.data,!1),U[$]?Ri($,U[$]):
Mi(),tl=xe.show&&(xe.width>0||xe.height>0),Gn=Ft=!0,ki(e.width,e.height)}return w.forEach(La),P.forEach(bd),n?n instanceof
HTMLElement?(n.appendChild(m),Bi()):n(r,Bi):Bi(),r}Ze.assign=Re;Ze.fmtNum=_a;Ze.rangeNum=ui;Ze.rangeLog=pi;Ze.rangeAsinh=
ga;Ze.orient=mr;Ze.pxRatio=ce;Ze.join=uv;Ze.fmtDate=xa,Ze.tzDate=xv;Ze.sync=$p;{Ze.addGap=n0,Ze.clipGaps=hi;let e=Ze.paths=
{points:Up};e.linear=Gp,e.stepped=l0,e.bars=i0,e.spline=a0}var b0=8;function Yp(e){let t=[...e.touches].map(o=>o.clientX),n=Math.min(...t),r=Math.max(...t);return{fingers:t.length,
middle:(n+r)/2,spread:r-n}}function Kp(e){let t=null;e.addEventListener("touchstart",n=>t=Yp(n),{passive:!0}),e.addEventListener(
"touchend",()=>t=null,{passive:!0}),e.addEventListener("touchmove",n=>{let r=Yp(n),{left:o,width:l}=e.getBoundingClientRect();
(!t||t.fingers!==r.fingers)&&(t=r),!(Math.abs(r.middle-t.middle)+Math.abs(r.spread-t.spread)<b0)&&(r.fingers>1&&r.spread>
0&&t.spread>0&&fn(t.spread/r.spread,(r.middle-o)/l),Go((t.middle-r.middle)/l),t=r)},{passive:!0})}var ed=220,Zp=[[],[6,3],[2,2],[8,3,2,3]],bi=I(null),Ea=e=>String(e).padStart(2,"0");function x0(e,t){let n=new Date(e*1e3),
r=`${Ea(n.getHours())}:${Ea(n.getMinutes())}:${Ea(n.getSeconds())}`;return t?`${r}.${Math.floor(n.getMilliseconds()/100)}`:
r}var w0=(e,t,n,r,o)=>t.map(l=>x0(l,o<1));function Jp(e,t,n,r,o){let[l="",a="0"]=Number(o.toPrecision(3)).toExponential().
split("e"),c=Math.max(0,Math.min(9,l.replace(/\D/g,"").length-1-Number(a))),d=Math.max(...t.map(Math.abs));return t.map(
m=>d>=1e7?m.toExponential(2):m.toFixed(c))}var Na=e=>e.axis===1,y0=56,Xo=new Map;function Xp(e,t,n){for(let o of Xo.keys())
o.root.isConnected||Xo.delete(o);let r=Xo.get(e)??[];return r[n]=Math.max(0,...(t??[]).map(o=>7*o.length+12)),Xo.set(e,r),
Math.max(y0,...[...Xo.values()].flat())}function S0(e,t){let n=lr("dim"),r={stroke:lr("line"),width:1},l={stroke:n,font:"\
11px system-ui, sans-serif",ticks:{...r,size:4},grid:r};return[{...l,values:w0,space:70,size:28},{...l,scale:"0",values:Jp,
size:Xp,space:32},{...l,scale:"1",values:t?Jp:()=>[],ticks:{...l.ticks,show:t},size:Xp,space:32,side:1,show:e,grid:{show:!1}}]}
function Qp(e,t,n){if(t===null||n===null||!Number.isFinite(t)||!Number.isFinite(n))return[0,1];let r=(n-t)*.08||Math.abs(
n)*.1||1;return[t-r,n+r]}function k0(e){return e.map((t,n)=>({label:t.formula,scale:String(t.axis),stroke:lr(`series-${n%
qr}`),width:1.5,dash:Zp[Math.floor(n/2)%Zp.length],points:{size:4}}))}function M0(e,t){return{width:t,height:ed,legend:{
show:!1},padding:[8,24,0,0],cursor:{sync:{key:"time"},drag:{x:!0,y:!1,setScale:!1},focus:{prox:-1}},scales:{x:{time:!0,auto:!1},
0:{range:Qp},1:{range:Qp}},axes:S0(he.value.flat().some(Na),e.some(Na)),series:[{},...k0(e)],hooks:{setSelect:[T0],setCursor:[
E0]}}}function T0(e){let{left:t,width:n}=e.select;n<4||(sr({from:e.posToVal(t,"x"),to:e.posToVal(t+n,"x")}),e.setSelect(
{left:0,top:0,width:0,height:0},!1))}function E0(e){let{left:t}=e.cursor;bi.value=t==null||t<0?null:e.posToVal(t,"x")}var A0=(e,{
scale:t,offset:n})=>Array.from(e,r=>Number.isFinite(r)?r*t+n:null);function N0(e,t){let n=Jt(),r=e.map(o=>{let[l,a]=vf(ar(
o,n),t);return[l,A0(a,o)]});return r.length===1?r[0]:Ze.join(r,r.map(o=>o.map(()=>1)))}function Aa(e,t){let{from:n,to:r}=Jt();
e.batch(()=>{e.setData(N0(t,e.width),!1),e.setScale("x",{min:n,max:r})})}function P0(e,t){e.preventDefault();let{left:n,
width:r}=t.over.getBoundingClientRect();fn(e.deltaY>0?1.25:.8,(e.clientX-n)/r)}function O0(e,t){let n=new Ze(M0(t,e.clientWidth),
[[],...t.map(()=>[])],e);n.over.addEventListener("wheel",o=>P0(o,n),{passive:!1}),Kp(n.over);let r=new ResizeObserver(()=>{
n.setSize({width:e.clientWidth,height:ed})});return r.observe(e),{chart:n,destroy:()=>{r.disconnect(),n.destroy()}}}function F0(e){
let t=setInterval(()=>{!document.hidden&&It.value===null&&e()},250);return()=>clearInterval(t)}function td({plot:e,onChart:t}){
let n=$t(null),r=$t(null),o=JSON.stringify([e,he.value.flat().some(Na)]);return Qe(()=>{if(!n.current)return;let l=O0(n.
current,e);r.current=l.chart,t(l.chart),Aa(l.chart,e);let a=F0(()=>Aa(l.chart,e));return()=>{a(),l.destroy(),r.current=null,
t(null)}},[o,xs.value]),Qe(()=>{r.current&&Aa(r.current,e)},[Zt.value,It.value]),i("div",{class:"chart",ref:n,role:"img",
"aria-label":`Plot of ${e.map(l=>l.formula).join(", ")}`})}function nd(e,t){return(()=>{if(t.value===null&&It.value===null)
return cn(e)?.points.latest??NaN;let{from:r,to:o}=Jt(),l=t.value??o,[a,c]=ar(e,{from:r,to:o}),d=NaN;for(let m=0;m<a.length&&
a[m]<=l;++m)d=c[m];return d})()*e.scale+e.offset}function C0(e,t,n){he.value=he.value.flatMap((r,o)=>{if(o!==e)return[r];let l=r.flatMap((a,c)=>c!==t?[a]:n?[{...a,...n}]:
[]);return l.length>0?[l]:[]})}function yi(e,t){let n=e.dataTransfer?.getData(Vs);if(!n)return;e.preventDefault();let{topic:r,
formula:o}=JSON.parse(n);Do(Br(String(r),String(o)),t)}var Sn=I(""),Ht=I(""),xi=I("new"),D0=mt(()=>(qt.value,[...at.values()].
filter(e=>e.schema).map(e=>e.topic).sort())),wi=mt(()=>(qt.value,Ht.value===""?null:pf(Ht.value,Sn.value,e=>at.get(e)?.schema))),
Pa=mt(()=>ff(Ht.value,Sn.value));function L0(e){e.preventDefault(),!(Pa.value===""||Ht.value===""||wi.value)&&(Do(Br(Pa.
value,Ht.value),xi.value==="new"?null:Number(xi.value)),Ht.value="")}function od({text:e,found:t,id:n}){return t?i("p",{
class:"fault",role:"alert",id:n,children:[i("code",{children:[e.slice(0,t.at),i("mark",{children:e.slice(t.at,t.at+1)||"\
 "}),e.slice(t.at+1)]}),i("span",{children:["at ",t.at+1,": ",t.message]})]}):null}var Oa=e=>t=>{e.value=t.currentTarget.
value};function ld(){Sn.value===""&&Ht.value===""&&(Sn.value=ye.value??"")}var $0=()=>i("label",{children:["Topic",i("in\
put",{id:"topic",list:"topics",class:"mono",placeholder:"/1/1/VFR_HUD",value:Sn.value,autocomplete:"off",spellcheck:!1,onFocus:ld,
onInput:Oa(Sn)}),i("datalist",{id:"topics",children:D0.value.slice(0,500).map(e=>i("option",{value:e},e))})]}),R0=()=>i(
"label",{class:"grow",children:["Formula",i("input",{id:"formula",class:"mono",placeholder:"sqrt(vx^2 + vy^2) / 100",value:Ht.
value,autocomplete:"off",spellcheck:!1,"aria-invalid":wi.value!==null,"aria-describedby":"fault",title:"Fields of anothe\
r topic have its name before them: /2/1/VFR_HUD.alt",onFocus:ld,onInput:Oa(Ht)})]}),I0=()=>i("label",{children:["Into",i(
"select",{value:xi.value,onChange:Oa(xi),children:[i("option",{value:"new",children:"a new plot"}),he.value.map((e,t)=>i(
"option",{value:t,children:["plot ",t+1]},t))]})]});function V0(){let e=Sn.value!==""&&!at.has(Sn.value);return i("form",
{class:"formula",onSubmit:L0,children:[i($0,{}),i(R0,{}),i(I0,{}),i("button",{type:"submit",disabled:Pa.value===""||Ht.value===
""||wi.value!==null,children:"Plot"}),e&&Ht.value!==""&&i("p",{class:"fault warning",children:["No ",Sn.value," has come\
 yet: the plot waits for it."]}),i(od,{text:Ht.value,found:wi.value,id:"fault"})]})}function z0(){Zt.value;let e=It.value!==
null;return i("div",{class:"toolbar",children:[i("button",{"aria-pressed":e,onClick:()=>e?Wo():sr(),title:"Stop or follo\
w (space)",children:[i(ue,{name:e?"play":"pause"}),e?"Follow":"Pause"]}),i("label",{children:["Last"," ",i("select",{value:Ln.
value,onChange:t=>{Ln.value=Number(t.currentTarget.value),Wo()},children:gs.map(t=>i("option",{value:t,children:t<60?`${t}\
 s`:`${t/60} min`},t))})]}),i("span",{class:"group",children:[i("button",{onClick:()=>fn(.5),"aria-label":"Zoom in",title:"\
Zoom in (+)",children:"+"}),i("button",{onClick:()=>fn(2),"aria-label":"Zoom out",title:"Zoom out (\u2212)",children:"\u2212"})]}),
i("span",{class:"summary dim number",children:e&&`stands still \xB7 ${ut(gf())} new points`})]})}function H0(e){let[,t]=ar(
e,Jt()),n=1/0,r=-1/0;for(let l of t)l<n&&(n=l),l>r&&(r=l);let o=[n*e.scale+e.offset,r*e.scale+e.offset];return[Math.min(
...o),Math.max(...o)]}function rd({label:e,value:t,onValue:n}){return i("input",{type:"number",step:"any","aria-label":e,
title:e,value:t,onChange:r=>{n(Number(r.currentTarget.value)||(e==="Scale"?1:0))}})}function U0({series:e}){Zt.value;let t=cn(
e),n=t!==void 0&&t.total===0;if(t?.fault||n)return i("td",{class:t?.fault?"error":"dim",colSpan:4,children:t?.fault?"wro\
ng formula":"waits for its first message"});let[r,o]=H0(e);return i(te,{children:[i("td",{class:"number mono strong",children:jr(
nd(e,bi))}),i("td",{class:"dim",children:e.scale===1?t?.unit:""}),i("td",{class:"number mono dim",children:jr(r)}),i("td",
{class:"number mono dim",children:jr(o)})]})}function W0({series:e,set:t}){let n=e.axis===1,r=`Axis of ${e.formula}: ${n?
"right":"left"}`;return i(te,{children:[i("td",{children:i("button",{class:"axis","aria-label":r,title:r,onClick:()=>t({
axis:n?0:1}),children:n?"right":"left"})}),i("td",{children:i(rd,{label:"Scale",value:e.scale,onValue:o=>t({scale:o})})}),
i("td",{children:i(rd,{label:"Offset",value:e.offset,onValue:o=>t({offset:o})})}),i("td",{children:i("button",{class:"qu\
iet","aria-label":`Remove ${e.formula}`,title:"Remove",onClick:()=>t(null),children:i(ue,{name:"close"})})})]})}function G0({
series:e,at:t,index:n}){let r=cn(e)?.fault??null,o=i("tr",{children:[i("td",{children:i("i",{class:`swatch s${n%qr} d${Math.
floor(n/2)%4}`})}),i("th",{scope:"row",class:"mono",children:i("span",{class:"cut",title:`${e.formula} of ${e.topic}`,children:[
e.formula," ",!e.formula.includes(e.topic)&&i("span",{class:"dim",children:e.topic})]})}),i(U0,{series:e}),i(W0,{series:e,
set:l=>C0(t,n,l)})]});return r?i(te,{children:[o,i("tr",{class:"wrong",children:[i("td",{}),i("td",{colSpan:9,children:i(
od,{text:e.formula,found:r})})]})]}):o}function B0({plot:e,at:t}){return Zt.value,i("table",{class:"legend",children:[i(
"caption",{class:"hidden",children:["Series of plot ",t+1]}),i("thead",{children:i("tr",{children:[i("td",{}),i("th",{scope:"\
col",children:"Series"}),i("th",{scope:"col",class:"number",children:bi.value===null?"Latest":"Pointer"}),i("td",{}),i("\
th",{scope:"col",class:"number",children:"Least"}),i("th",{scope:"col",class:"number",children:"Most"}),i("th",{scope:"c\
ol",children:"Axis"}),i("th",{scope:"col",children:"Scale"}),i("th",{scope:"col",children:"Offset"}),i("td",{})]})}),i("\
tbody",{children:e.map((n,r)=>i(G0,{series:n,at:t,index:r},xn(n)))})]})}function j0({at:e,plot:t,savePicture:n}){let r=()=>{
he.value=he.value.filter((o,l)=>l!==e)};return i("header",{children:[i("h3",{children:["Plot ",e+1]}),i("span",{class:"g\
roup end",children:[i("button",{onClick:()=>xf(t),title:"Save what is shown as CSV",children:"CSV"}),i("button",{onClick:n,
title:"Save the picture",children:"PNG"}),i("button",{class:"quiet",onClick:r,"aria-label":`Remove plot ${e+1}`,title:"R\
emove the plot",children:i(ue,{name:"close"})})]})]})}function q0({plot:e,at:t}){let n=$t(null),r=l=>{n.current=l},o=()=>{
n.current&&wf(n.current.ctx.canvas,e)};return i("section",{class:"panel plot","aria-label":`Plot ${t+1}`,onDragOver:l=>l.
preventDefault(),onDrop:l=>yi(l,t),children:[i(j0,{at:t,plot:e,savePicture:o}),i(td,{plot:e,onChart:r}),i(B0,{plot:e,at:t})]})}
function Y0(){return i("div",{class:"empty start",children:[i(ue,{name:"plot"}),i("p",{children:["Open a message under ",
i("b",{children:"Messages"})," and click a number, or type a formula above."]})]})}var K0={" ":()=>It.value?Wo():sr(),"+":()=>fn(
.5),"=":()=>fn(.5),"-":()=>fn(2),ArrowLeft:()=>Go(-.25),ArrowRight:()=>Go(.25),0:Wo,a:()=>Rn("#formula")};function id(){
$r(()=>Ul(K0),[]),gt.value;let e=ye.value!==null;return i(te,{children:[i("h2",{class:"hidden",children:"Plots"}),i("div",
{class:"list",onDragOver:t=>t.preventDefault(),onDrop:t=>{t.defaultPrevented||yi(t,null)},children:[i(z0,{}),i(V0,{}),i(
"div",{class:"scroller",tabIndex:-1,children:he.value.length===0?i(Y0,{}):he.value.map((t,n)=>i(q0,{plot:t,at:n},n))})]}),
e&&i(Jl,{hz:null})]})}var sd={overview:"Overview",messages:"Messages",plots:"Plots"},ad=e=>`#${Rl({...bs(),view:e})}`,ud=I(!1);Le(()=>{ht.value&&
(ud.value=!0)});Le(()=>{No.value!==""&&Gr(No.value)});var ao=mt(()=>ht.value?"live":ud.value?"lost":"connecting"),Z0=mt(
()=>Ur.value.filter(e=>e.ended_us===null&&e.severity!=="info"));function Fa({to:e}){let t=e!=="plots"?{}:{onDragOver:n=>n.
preventDefault(),onDrop:n=>yi(n,null)};return i("a",{href:ad(e),"aria-current":He.value===e?"page":void 0,...t,children:sd[e]})}
function J0(){let e=Z0.value,t=e.some(n=>n.severity==="error")?"error":"warning";return e.length===0?null:i("a",{class:`\
badge ${t}`,href:ad("overview"),children:[i(ue,{name:t}),e.length,i("span",{class:"wide",children:[" ",e.length===1?"ala\
rm":"alarms"]})]})}function X0(){let e={live:"live",lost:"lost",connecting:"opening"}[ao.value];return i("span",{class:`\
badge ${ao.value}`,title:Ao.value,children:[i(ue,{name:ao.value}),e]})}function Q0(){if(ao.value!=="lost")return null;gt.
value;let e=zr.value===null?0:Math.max(0,Math.ceil((zr.value-Date.now())/1e3));return i("div",{class:"banner",children:[
i(ue,{name:"lost"}),i("span",{children:[i("strong",{children:"Connection lost"})," ",Yt((Date.now()-(To.value??Date.now()))/
1e3)," ago. Values are old. ",e>0?`Next attempt in ${e} s.`:"Connecting\u2026"]}),i("button",{onClick:Po,children:"Try n\
ow"})]})}function e_(){return i("header",{children:[i("h1",{children:"mavloom"}),i("nav",{"aria-label":"Views",children:[
i(Fa,{to:"overview"}),i(Fa,{to:"messages"}),i(Fa,{to:"plots"})]}),i("div",{class:"right",children:[i(J0,{}),i(X0,{}),i("\
button",{class:"quiet",onClick:zl,title:`Colours: ${$n.value} (t)`,"aria-label":`Colours: ${$n.value}`,children:i(ue,{name:$n.
value})}),i("button",{class:"quiet",onClick:()=>{Mt.value=!0},title:"Keys and licences (?)","aria-label":"Help",children:i(
ue,{name:"help"})})]})]})}var t_={overview:uf,messages:Hc,plots:id};function cd(){Qe(()=>nr.use(),[]),Qe(()=>{document.title=
`${sd[He.value]} \xB7 Mavloom`},[He.value]);let e=t_[He.value];return i("div",{class:`app ${ao.value}`,children:[i(e_,{}),
i(Q0,{}),i("main",{class:He.value,children:i(e,{})}),i("div",{class:"notice",role:"status",hidden:Co.value==="",children:Co.
value}),i("div",{class:"hidden",role:"status",children:ao.value==="lost"?"The connection is lost":""}),i(xc,{})]})}ac();Sc();df();Po();Qu();addEventListener("keydown",_c);var fd=document.getElementById("app");fd&&wu(i(cd,{}),fd);})();
